//! Buffers anywhere in the 2 GB: over the borders of pages, which lie in physical memory in another order, and up to
//! the very last line.

use contact_afu::cosim::spl2::{MachineError, Place, Session};
use contact_afu::link::spl2::{MAX_PAGES, PAGE_BYTES, Spl2Error};

use crate::bench::{Case, machine, model, quick};

const PAGE_LINES: u64 = PAGE_BYTES / 64;

#[test]
fn over_the_borders_of_pages_and_in_the_last_line_of_2_gb() {
    let case = Case::random(401, 8);
    let lines = case.place().lines;
    let half = u64::from(lines) / 2;
    let all = MAX_PAGES * PAGE_LINES;
    let model = model(3);
    let afu = model.instance(2).unwrap();
    for (link, pages, source, destination) in [
        ("ideal", 3, PAGE_LINES - half, 2 * PAGE_LINES - half),
        ("shuffled", 3, 2 * PAGE_LINES - half, PAGE_LINES - half),
        ("hostile", 3, PAGE_LINES - 1, 2 * PAGE_LINES - 1),
        ("late", MAX_PAGES, 2, all - u64::from(lines)),
        ("ideal", MAX_PAGES, all - u64::from(lines), 2),
    ] {
        let mut machine = machine(&afu, quick(), link, 2);
        let place = Place { pages, source, destination, lines };
        let mut session = Session::open(&mut machine, place, Some(3)).unwrap();
        case.check(&session.run(&case.job()).unwrap(), &format!("{link}, {place:?}"));
        let last = session.physical(destination + u64::from(lines) - 2);
        assert!(machine.memory().get(last).is_some());
    }
}

/// The host's own mistake is the host's error, and one the host made in the page table is seen.
#[test]
fn what_lies_outside_is_refused() {
    let case = Case::random(5, 8);
    let afu = model(3).instance(2).unwrap();
    let mut machine = machine(&afu, quick(), "ideal", 2);
    let place = Place { pages: 1, source: 2, destination: PAGE_LINES - 2, lines: 4 };
    let refused = Session::open(&mut machine, place, None).unwrap_err();
    assert!(matches!(refused, MachineError::Workspace(_)), "{refused}");
    let overlapping = Place { source: 5, destination: 7, ..place };
    assert!(matches!(Session::open(&mut machine, overlapping, None).unwrap_err(), MachineError::Workspace(_)));

    // Two pages are laid out, SPL is told of one: the results' page faults.
    let place = Place { pages: 2, source: 2, destination: PAGE_LINES, lines: 4 };
    let mut session = Session::open(&mut machine, place, None).unwrap();
    session.machine().write_csr(0x1010, 0).unwrap();
    let context = 0x3000 / 64;
    let mut line = *session.machine().memory().get(context).unwrap();
    line[5] = 1;
    session.machine().memory_mut().set(context, &line);
    session.machine().write_csr(0x1010, 2).unwrap();
    let fault = session.run(&case.job()).unwrap_err();
    let is_fault = matches!(fault, MachineError::Protocol { what: Spl2Error::PageFault { what: "write", .. }, .. });
    assert!(is_fault, "{fault}");
}
