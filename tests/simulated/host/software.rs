//! Transactions with the AFU in software: successful ones, and rejected inputs.

use contact_afu::afu::shell::spl2::map::{self, control, identity, pointers, status};
use contact_afu::config::{Config, RecordFormat, Results};
use contact_afu::host::{Expected, HitError, HostError, Session, Software, Transport, TransportError, Workspace};
use contact_afu::kernel::Engine;
use contact_afu::link::LinkModel;
use contact_afu::link::spl2::CsrOffset;
use contact_afu::query::PairRecord;

use super::meddle::{Dying, Meddled};
use super::{config, contacts, expected, pairs, session, software};

#[test]
fn seven_steps_give_the_reference_s_contacts() {
    let mut session = session(software(), 1);
    for count in [1000, 0, 1, 2, 3, 32_764] {
        let pairs = pairs(count);
        let results = session.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap();
        let results = results.wait().unwrap().retrieve().unwrap().end().unwrap();
        assert_eq!(results.contacts, contacts(&pairs), "{count}");
        assert_eq!(results.hits as usize, results.contacts.iter().filter(|contact| contact.is_contact()).count());
        assert_eq!(results.report.pairs, count);
    }
    assert_eq!(session.reports().len(), 6);
}

#[test]
fn an_engine_splits_what_the_buffers_do_not_hold() {
    let mut session = session(software(), 1);
    let pairs = pairs(70_000);
    assert_eq!(session.contacts(&pairs).unwrap(), contacts(&pairs));
    let sizes: Vec<u64> = session.reports().iter().map(|report| report.pairs).collect();
    assert_eq!(sizes, [32_764, 32_764, 4_472]);
    assert_eq!(session.contacts(&[]).unwrap(), []);
    assert_eq!(session.reports().len(), 3, "no pairs, no transaction");
}

#[test]
fn two_gigabytes_take_only_what_is_used() {
    let mut session = session(software(), 1024);
    let workspace = session.workspace();
    assert_eq!((workspace.bytes(), workspace.capacity()), (2 << 30, 33_554_428));
    let pages = [workspace.source(), workspace.destination()].map(|address| (address - workspace.context()) >> 21);
    assert_eq!(pages, [0, 512]);
    let pairs = pairs(40_000);
    assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs));
}

#[track_caller]
fn refused<T: Transport>(session: &mut Session<T>, pairs: &[PairRecord]) -> HostError {
    session.run(pairs).unwrap_err()
}

#[test]
fn more_pairs_than_the_buffers_hold_are_refused_before_anything_is_sent() {
    let mut session = session(software(), 1);
    let error = session.transaction().send(&pairs(32_765)).unwrap_err();
    assert_eq!(error, HostError::TooManyPairs { pairs: 32_765, capacity: 32_764, pages: 2 });
    assert!(error.to_string().contains("give the workspace 2 pages"), "{error}");
    assert!(session.transport().device_writes().is_empty());
}

#[test]
fn another_afu_is_refused_by_what_differs() {
    let other = |config: Config| {
        let mut session = session(Software::new(&config, Default::default()).unwrap(), 1);
        refused(&mut session, &pairs(3)).to_string()
    };
    let scpus = other(Config { scpus: 3, ..config() });
    assert!(scpus.starts_with("the FPGA's AFU differs in SCPUs: expected 10, found 3; load"), "{scpus}");
    let fields = other(Config { contact: "depth".parse().unwrap(), ..config() });
    assert!(fields.contains("the lowest bit up): expected 15, found 3"), "{fields}");
    let profile = other(Config { profile: "paper".parse().unwrap(), ..config() });
    assert!(profile.contains("SCPU latency (of profile and clock)"), "{profile}");
}

/// Changes a field of the AFU's identity in the DSM as soon as it is written.
fn pretends(field: map::Field, value: u128) -> HostError {
    let device = Meddled::new(software(), move |device: &mut Software| {
        let Some(at) = device.device_writes().first().map(|write| write.address) else { return };
        let Some(mut line) = device.memory().get(at).copied() else { return };
        field.set(&mut line, value);
        device.memory_mut().set(at, &line);
    });
    refused(&mut session(device, 1), &pairs(3))
}

#[test]
fn another_identity_or_version_is_refused() {
    let error = pretends(identity::AFU_ID, 0xBAD);
    assert_eq!(error, HostError::Identity { afu_id: 0xBAD, version: map::VERSION, expected: map::VERSION });
    let error = pretends(identity::VERSION, 99);
    assert_eq!(error, HostError::Identity { afu_id: map::AFU_ID, version: 99, expected: map::VERSION });
    assert!(error.to_string().contains("load the AFU that this version of the program generates"), "{error}");
}

/// A device that dies after `left` CSR writes. Whatever the host then waits for never arrives.
#[test]
fn a_dead_device_is_a_time_out_that_says_for_what() {
    // The CSR writes: reset; SPL DSM (2), AFU DSM (2), SPL context (2), AFU context (2), enable.
    for left in 0..10 {
        let mut session = session(Dying { device: software(), left, cycles: 0 }, 1);
        let error = refused(&mut session, &pairs(3));
        let text = error.to_string();
        if left < 5 {
            assert!(matches!(error, HostError::NoIdentity(_)), "{left}: {text}");
            assert!(text.starts_with("AFU_ID not in the DSM after "), "{text}");
        } else {
            assert!(matches!(error, HostError::NoStatus { .. }), "{left}: {text}");
            assert!(
                text.starts_with("the job did not finish after ") && text.contains("end the transaction"),
                "{text}"
            );
        }
        let waited = match error {
            HostError::NoIdentity(cycles) | HostError::NoStatus { cycles, .. } => cycles,
            _ => 0,
        };
        assert!((512..5_000).contains(&waited), "{left}: longer than a poll takes, and not for ever: {text}");
    }
    let mut session = session(Dying { device: software(), left: 9, cycles: 0 }, 1);
    session.max_cycles = Some(50);
    let error = refused(&mut session, &pairs(3));
    assert!(matches!(error, HostError::NoStatus { cycles: 51..=80, .. }), "{error}");
}

/// Changes memory once the status of a job is there.
fn at_status(device: Software, mut meddle: impl FnMut(&mut Software, u64) + 'static) -> Meddled<Software> {
    Meddled::new(device, move |device: &mut Software| {
        let is_status = |line: &[u32; 16]| status::DONE.get(line) == 1 && status::AFU_ID.get(line) == map::AFU_ID;
        let found = device.device_writes().iter().rev().find(|write| is_status(&write.data)).map(|write| write.address);
        if let Some(at) = found {
            meddle(device, at);
        }
    })
}

#[test]
fn a_line_that_was_never_written_is_no_result() {
    let mut plain = session(software(), 1);
    let lost = plain.workspace().physical(plain.workspace().destination() + 64).unwrap();
    plain.run(&pairs(6)).unwrap();
    let device = at_status(software(), move |device, _| device.memory_mut().forget(lost..lost + 1));
    assert_eq!(refused(&mut session(device, 1), &pairs(6)), HostError::Unwritten(1));
}

#[test]
fn a_page_that_is_not_there_is_named() {
    let plain = session(software(), 1);
    let context = plain.workspace().physical(plain.workspace().context()).unwrap();
    let beyond = plain.workspace().context() + (2 << 20);
    let device = Meddled::new(software(), move |device: &mut Software| {
        if let Some(mut line) = device.memory().get(context).copied() {
            pointers::DESTINATION.set(&mut line, beyond.into());
            device.memory_mut().set(context, &line);
        }
    });
    let error = refused(&mut session(device, 1), &pairs(6));
    let fault = TransportError::PageFault { what: "write", line: beyond / 64 };
    assert_eq!(error, HostError::Transport(fault));
}

#[test]
fn an_error_of_the_device_says_what_to_do() {
    let plain = session(software(), 1);
    let context = plain.workspace().physical(plain.workspace().context()).unwrap();
    let device = Meddled::new(software(), move |device: &mut Software| {
        if let Some(mut line) = device.memory().get(context).copied() {
            pointers::LINES.set(&mut line, 3);
            device.memory_mut().set(context, &line);
        }
    });
    let error = refused(&mut session(device, 1), &pairs(6));
    assert!(matches!(error, HostError::Job { code: 8, .. }), "{error}");
    assert!(error.to_string().contains("the job takes more lines than the buffers have): send fewer pairs"), "{error}");
}

#[test]
fn invalid_pairs_are_named_by_number_and_field() {
    let mut session = session(software(), 1);
    let mut pairs = vec![PairRecord::from_spheres([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]); 9];
    pairs[5].0[7] = (-1.0_f32).to_bits();
    pairs[8].0[0] = f32::NAN.to_bits();
    let done = session.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
    let results = done.retrieve().unwrap().end().unwrap();
    let error = results.strict(&pairs).unwrap_err();
    assert_eq!(error, HostError::InvalidPairs { count: 2, first: 5, field: "r2", record: RecordFormat::F32 });
    let good = session.transaction().send(&pairs[..5]).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
    assert_eq!(good.retrieve().unwrap().end().unwrap().strict(&pairs[..5]), Ok(()));
}

/// Records of 16 bits: four pairs per line, and the reference's contacts. An AFU with other records is rejected.
#[test]
fn records_of_16_bits_are_agreed_on() {
    let pairs = pairs(1000);
    for record in [RecordFormat::F16, RecordFormat::Bf16] {
        let config = Config { record, ..config() };
        let expected = Expected::new(&config).unwrap();
        assert_eq!(expected.layout.pairs_per_line(), 4);
        let workspace = || Workspace::new(expected.layout, 1, 7).unwrap();
        let device = Software::new(&config, LinkModel::ideal()).unwrap();
        let contacts = Session::new(device, workspace(), expected).run(&pairs).unwrap();
        assert_eq!(contacts, config.reference().run_all(&pairs));
        assert_ne!(contacts, super::contacts(&pairs));
        let error = Session::new(software(), workspace(), expected).run(&pairs).unwrap_err();
        assert!(error.to_string().contains("words of records (0: f32, 1: f16, 2: bf16)"), "{error}");
    }
    // A number too large for f16 makes its pair invalid, and the host reports that.
    let config = Config { record: RecordFormat::F16, ..config() };
    let expected = Expected::new(&config).unwrap();
    let device = Software::new(&config, LinkModel::ideal()).unwrap();
    let mut session = Session::new(device, Workspace::new(expected.layout, 1, 7).unwrap(), expected);
    let far = [PairRecord::from_spheres([0.0, 0.0, 65_520.0, 1.0], [0.0; 4])];
    let done = session.transaction().send(&far).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
    let error = done.retrieve().unwrap().end().unwrap().strict(&far).unwrap_err().to_string();
    assert!(error.contains("the z1 of the first, pair 0, is in f16 NaN, infinite"), "{error}");
}

/// Only contacts come back: one record per pair that touches, with its number. The engine still returns one per pair.
#[test]
fn hits_come_back_with_their_numbers() {
    for contact in ["hit", "depth", "depth,normal,position"] {
        let config = Config { results: Results::Hits, contact: contact.parse().unwrap(), ..config() };
        let expected = Expected::new(&config).unwrap();
        let device = Software::new(&config, LinkModel::ideal()).unwrap();
        let mut session = Session::new(device, Workspace::new(expected.layout, 1, 7).unwrap(), expected);
        for count in [500, 0, 1] {
            let pairs = pairs(count);
            let all = config.reference().run_all(&pairs);
            let done = session.transaction().send(&pairs).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
            let lines = done.outcome().lines;
            let results = done.retrieve().unwrap().end().unwrap();
            let touching: Vec<u32> = (0..).zip(&all).filter(|(_, one)| one.is_contact()).map(|(i, _)| i).collect();
            assert_eq!(results.numbers, touching, "{contact}");
            assert_eq!(lines.iter().flatten().count() as u64, expected.layout.destination_lines(touching.len() as u64));
            let by_pair = results.by_pair();
            assert_eq!((by_pair.len(), results.hits as usize), (pairs.len(), touching.len()));
            for (number, (one, of_all)) in by_pair.iter().zip(&all).enumerate() {
                assert_eq!(one.is_contact(), of_all.is_contact(), "{contact}: pair {number}");
                let full = contact == "depth,normal,position" && one.is_contact();
                assert!(!full || one == of_all, "{contact}: pair {number}");
            }
            assert_eq!(session.contacts(&pairs).unwrap(), by_pair);
        }
    }
}

/// Records of hits that cannot be right are rejected.
#[test]
fn hits_that_are_missing_or_of_no_pair_are_refused() {
    let config = Config { results: Results::Hits, ..config() };
    let expected = Expected::new(&config).unwrap();
    let workspace = Workspace::new(expected.layout, 1, 7).unwrap();
    let first = workspace.physical(workspace.destination()).unwrap();
    let touching = vec![PairRecord::from_spheres([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]); 3];
    let run = |meddle: fn(&mut Software, u64)| {
        let software = Software::new(&config, LinkModel::ideal()).unwrap();
        let device = at_status(software, move |device, _| meddle(device, first));
        Session::new(device, workspace.clone(), expected).run(&touching).unwrap_err()
    };
    let error = run(|device, first| device.memory_mut().forget(first + 1..first + 2));
    assert_eq!(error, HostError::Hit(HitError::Unwritten { index: 1, count: 3 }));
    let error = run(|device, first| {
        let line = device.memory().get(first).copied().unwrap();
        device.memory_mut().set(first + 1, &line);
    });
    assert_eq!(error, HostError::Hit(HitError::Number { index: 1, number: 0, after: Some(0), pairs: 3 }));
    let error = run(|device, first| device.memory_mut().set(first, &[3; 16]));
    assert!(error.to_string().starts_with("contact 0 is of pair 3, after no other, of 3 pairs, although"), "{error}");
}

/// A second job without restarting SPL, after results and after an error.
#[test]
fn the_next_job_needs_no_reset() {
    let device = Meddled::new(software(), |_| ());
    let csrs = device.csrs.clone();
    let mut session = session(device, 1);
    let at = session.workspace().physical(session.workspace().source()).unwrap();
    let (many, few) = (pairs(300), pairs(40));
    let done = session.transaction().send(&many).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
    let retrieved = done.retrieve().unwrap();
    assert_eq!(retrieved.results().contacts, contacts(&many));
    let writes = csrs.borrow().len();
    let mut started = retrieved.send_next(&few).unwrap().start().unwrap();
    let mut line = started.transport().device.memory().get(at).copied().unwrap();
    control::MODE.set(&mut line, 1);
    started.transport_mut().device.memory_mut().set(at, &line);
    let done = started.confirm().unwrap().wait().unwrap();
    assert_eq!(done.outcome().error, 5);
    let done = done.send_next(&few).unwrap().start().unwrap().confirm().unwrap().wait().unwrap();
    assert_eq!(csrs.borrow().len(), writes, "no register was written");
    let results = done.retrieve().unwrap().end().unwrap();
    assert_eq!((results.contacts, results.report.pairs), (contacts(&few), 40));
    let lines: Vec<_> = (1..150).map(|line| session.workspace().context() + 64 * line).collect();
    let left = lines.iter().filter(|&&line| {
        let at = session.workspace().physical(line).unwrap();
        session.transport().device.memory().get(at).is_some()
    });
    assert_eq!(left.count(), 1, "only the status: the pairs of both jobs are gone");
}

/// At whatever step a transaction is dropped, the device is stopped, the workspace is free, and the next transaction is
/// right.
#[test]
fn a_dropped_transaction_ends_properly() {
    let pairs = pairs(50);
    for step in 1..=7 {
        let device = Meddled::new(software(), |_| ());
        let csrs = device.csrs.clone();
        let mut session = session(device, 1);
        let first = session.workspace().physical(session.workspace().source() + 64).unwrap();
        let to_step = |session: &mut Session<Meddled<Software>>| -> Result<(), HostError> {
            let transaction = session.transaction();
            if step == 1 {
                return Ok(());
            }
            let transaction = transaction.send(&pairs)?;
            if step == 2 {
                return Ok(());
            }
            let transaction = transaction.start()?;
            if step == 3 {
                return Ok(());
            }
            let transaction = transaction.confirm()?;
            if step == 4 {
                return Ok(());
            }
            let transaction = transaction.wait()?;
            if step == 5 {
                return Ok(());
            }
            let transaction = transaction.retrieve()?;
            if step == 6 {
                return Ok(());
            }
            transaction.end().map(|_| ())
        };
        to_step(&mut session).unwrap();
        let control: Vec<u32> =
            csrs.borrow().iter().filter(|csr| csr.0 == CsrOffset::Control as u32).map(|csr| csr.1).collect();
        let wanted: &[u32] = if step == 1 { &[] } else { &[1, 2, 0, 1] };
        assert_eq!(control, wanted, "step {step}");
        assert_eq!(session.transport().device.memory().get(first), None, "step {step}: the source is free");
        assert_eq!(session.run(&pairs).unwrap(), contacts(&pairs), "step {step}");
    }
    assert_eq!(expected().layout.pairs_per_line(), 2);
}
