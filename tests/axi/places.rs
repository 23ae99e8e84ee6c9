//! Buffers anywhere in the 64-bit address space: at the end of 4 KB, across 4 GB, in the very last line. Where there is
//! no memory, the interconnect answers with an error, which the host names.

use contact_afu::host::{Expected, HostError, Workspace};
use contact_afu::link::LinkModel;
use contact_afu::link::axi::{DECERR, Handshake};
use contact_afu::outcome::{Channel, Failure};

use crate::bench::{Case, config, end, machine, model, run, session};

/// Lines of the 4 KB that no burst crosses, and of a page of the workspace.
const BURST_LINES: u64 = 64;
const PAGE_LINES: u64 = 1 << 15;

/// A workspace of so many pages from a byte address on.
fn workspace(first: u64, pages: u64, source: u64, destination: u64, lines: u32) -> Result<Workspace, HostError> {
    let layout = Expected::edited(&config(1, 512)).layout;
    // The end of the address space is no address, so the last byte is left out.
    let last = first.wrapping_add(pages * PAGE_LINES * 64).wrapping_sub(1);
    Workspace::in_buffer(layout, first..last)?.with_buffers(source, destination, lines)
}

#[test]
fn across_4_gb_and_in_the_last_line_of_the_address_space() {
    let case = Case::random(401, 8);
    let lines = case.lines();
    let (half, all) = (u64::from(lines) / 2, 2 * PAGE_LINES);
    let around_4_gb = (1 << 32) - PAGE_LINES * 64;
    let last_pages = 0_u64.wrapping_sub(all * 64);
    for bus in [512, 128] {
        let config = config(3, bus);
        let model = model(&config);
        for (link, handshake, first, source, destination) in [
            ("ideal", Handshake::Free, 0, 0, BURST_LINES * 4 - 1),
            ("shuffled", Handshake::Free, around_4_gb, PAGE_LINES - half, PAGE_LINES + half + 1),
            ("hostile", Handshake::DataFirst, around_4_gb, PAGE_LINES + half + 1, PAGE_LINES - half),
            ("late", Handshake::AddressFirst, last_pages, 0, all - u64::from(lines)),
            ("ideal", Handshake::Free, last_pages, all - u64::from(lines), 1),
        ] {
            let what = format!("{bus} bits, {link}, {first:#x}, lines {source} and {destination}");
            let afu = model.instance(2).unwrap();
            let workspace = workspace(first, 2, source, destination, lines).unwrap();
            let mut session = session(machine(&afu, link, handshake, 2), &config, workspace);
            case.check(&run(&mut session, &case).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
        }
    }
}

/// Buffers outside the workspace are refused by the host. An access of an address without memory ends the job with an
/// error that names channel, response and address, and the next job is right.
#[test]
fn what_lies_outside_is_refused() {
    assert!(matches!(workspace(0, 1, 2, PAGE_LINES - 2, 4), Err(HostError::Buffers(_))));
    assert!(matches!(workspace(0, 1, 5, 7, 4), Err(HostError::Buffers(_))));

    let case = Case::random(301, 9);
    let lines = u64::from(case.lines());
    for bus in [512, 128] {
        let config = config(3, bus);
        let model = model(&config);
        for (link, seed) in LinkModel::PRESETS.into_iter().zip(1..) {
            let afu = model.instance(seed).unwrap();
            let place = case.workspace(61, 13);
            let (source, destination) = (place.pairs() / 64, place.destination() / 64);
            let mut session = session(machine(&afu, link, Handshake::Free, seed), &config, place);
            for (channel, missing) in [
                (Channel::Read, 0),
                (Channel::Read, 70),
                (Channel::Read, lines - 1),
                (Channel::Write, 0),
                (Channel::Write, 70),
                (Channel::Write, lines - 1),
            ] {
                let what = format!("{bus} bits, {link}, {channel:?}, from line {missing} on");
                let begins = if channel == Channel::Read { source } else { destination };
                let first = begins + missing;
                let mut loaded = session.transaction().send(&case.pairs).unwrap();
                loaded.transport_mut().memory_mut().lacks(first..begins + lines);
                let done = end(loaded).unwrap_or_else(|e| panic!("{what}: {e}"));
                let outcome = done.outcome();
                case.check_written(&outcome, &what);
                let Some(Failure { channel: found, response: DECERR, address }) = outcome.failure else {
                    panic!("{what}: {:?}", outcome.failure)
                };
                // A read names its line. A write names its burst, in whose 4 KB the line is.
                let line = address / 64;
                let is_named = match channel {
                    Channel::Read => line == first,
                    Channel::Write => line <= first && line / BURST_LINES == first / BURST_LINES,
                };
                assert!(found == channel && is_named, "{what}: line {line:#x}, not {first:#x}");
                let error = done.retrieve().unwrap_err().to_string();
                let letter = if channel == Channel::Read { 'R' } else { 'B' };
                let named = format!("DECERR on channel {letter}");
                assert!(error.contains(&named) && error.contains(&format!("{address:#x}")), "{what}: {error}");
                session.transport_mut().memory_mut().lacks(0..0);
                case.check(&run(&mut session, &case).unwrap_or_else(|e| panic!("{what}: {e}")), &what);
            }
        }
    }
}
