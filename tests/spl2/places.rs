//! Buffers anywhere in the 2 GB: across page boundaries, with pages in a different order in physical memory, and up to
//! the very last line.

use contact_afu::host::{HostError, TransportError};
use contact_afu::link::spl2::{MAX_PAGES, PAGE_LINES};

use crate::bench::{Case, end, machine, model, quick, session, workspace};

#[test]
fn over_the_borders_of_pages_and_in_the_last_line_of_2_gb() {
    let case = Case::random(401, 8);
    let lines = case.room();
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
        let workspace = workspace(pages, source, destination, lines).unwrap();
        let last = workspace.physical(workspace.destination() + 64 * (u64::from(lines) - 2)).unwrap();
        let mut session = session(machine(&afu, quick(), link, 2), 3, workspace);
        let done = end(session.transaction().send(&case.pairs).unwrap()).unwrap();
        case.check(&done.outcome(), &format!("{link}, {pages} pages, {source}, {destination}"));
        assert!(done.transport().memory().get(last).is_some());
    }
}

/// Buffers outside the workspace are rejected by the host. A wrong page table leads to a page fault.
#[test]
fn what_lies_outside_is_refused() {
    assert!(matches!(workspace(1, 2, PAGE_LINES - 2, 4), Err(HostError::Buffers(_))));
    assert!(matches!(workspace(1, 5, 7, 4), Err(HostError::Buffers(_))));

    // Two pages are laid out, but SPL knows only one, so writing the results causes a page fault.
    let case = Case::random(5, 8);
    let afu = model(3).instance(2).unwrap();
    let place = workspace(2, 2, PAGE_LINES, 4).unwrap();
    let mut session = session(machine(&afu, quick(), "ideal", 2), 3, place);
    let mut loaded = session.transaction().send(&case.pairs).unwrap();
    let machine = loaded.transport_mut();
    machine.write_csr(0x1010, 0).unwrap();
    let context = 0x3000 / 64;
    let mut line = *machine.memory().get(context).unwrap();
    line[5] = 1;
    machine.memory_mut().set(context, &line);
    machine.write_csr(0x1010, 2).unwrap();
    let fault = end(loaded).unwrap_err();
    let is_fault = matches!(fault, HostError::Transport(TransportError::PageFault { what: "write", .. }));
    assert!(is_fault, "{fault}");
}
