//! Link models driven directly: order, latency, bandwidth, stalls, faults, and reproducibility from the seed.

use contact_afu::link::{
    Direction, Fault, Line, Link, LinkModel, Order, ReadRequest, Replies, Requests, Shape, Stalls, WriteRequest,
};

const CYCLES: u64 = 20_000;

/// Reads and writes as fast as the link allows, with at most 64 requests outstanding; returns every reply.
fn saturate(model: LinkModel, seed: u64, reading: bool, writing: bool) -> (Link, Vec<Replies>) {
    let mut link = Link::new(model, seed).unwrap();
    let mut replies = Vec::new();
    let (mut reads, mut writes) = (0u64, 0u64);
    for _ in 0..CYCLES {
        let traffic = link.traffic();
        let may_read = reading && traffic.reads - traffic.read_responses < 64;
        let may_write = writing && traffic.writes - traffic.write_responses < 64;
        let read = may_read.then_some(ReadRequest { address: reads, tag: (reads % 1024) as u16 });
        let data = [writes as u32; 16];
        let write = may_write.then_some(WriteRequest { address: writes, tag: (writes % 1024) as u16, data });
        let reply = link.cycle(&Requests { read, write });
        reads += u64::from(may_read && reply.read_ready);
        writes += u64::from(may_write && reply.write_ready);
        replies.push(reply);
    }
    (link, replies)
}

#[test]
fn every_preset_stays_within_its_limit_and_comes_near() {
    for name in LinkModel::PRESETS {
        for (reading, writing) in [(true, true), (true, false), (false, true)] {
            let (link, _) = saturate(name.parse().unwrap(), 7, reading, writing);
            let traffic = link.traffic();
            let limit = link.model().limit_cycles(traffic.read_responses, traffic.write_responses);
            let share = limit / CYCLES as f64;
            // In-order links delay responses behind a late one. The bound ignores that, so it is not reached.
            let least = if name == "late" { 0.75 } else { 0.93 };
            assert!((least..=1.02).contains(&share), "{name} {reading} {writing}: {share} of the limit, {traffic:?}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_cycles_and_another_others() {
    let run = |seed| saturate(LinkModel::hostile(), seed, true, true).1;
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn ideal_answers_in_the_next_cycle_every_cycle() {
    let (link, replies) = saturate(LinkModel::ideal(), 0, true, true);
    assert!(replies.iter().all(|reply| reply.read_ready && reply.write_ready));
    assert!(
        replies[0].read.is_none() && replies[1..].iter().all(|reply| reply.read.is_some() && reply.write.is_some())
    );
    assert_eq!(link.in_flight(), (1, 1));
    assert_eq!(link.memory.get(CYCLES - 2), Some(&[CYCLES as u32 - 2; 16]));
    assert_eq!(link.memory.get(CYCLES - 1), None, "a write that is not acknowledged is not in memory yet");
}

#[test]
fn order_is_kept_or_not() {
    let tags =
        |model| -> Vec<u16> { saturate(model, 3, true, false).1.iter().filter_map(|r| Some(r.read?.tag)).collect() };
    let in_order = |tags: &[u16]| tags.iter().enumerate().all(|(i, &tag)| usize::from(tag) == i % 1024);
    assert!(in_order(&tags(LinkModel::late())));
    assert!(!in_order(&tags(LinkModel::shuffled())));
    let mut late_in_any_order = LinkModel::late();
    late_in_any_order.order = Order::Shuffled;
    assert!(!in_order(&tags(late_in_any_order)));
}

#[test]
fn latency_lies_between_its_bounds() {
    let mut model = LinkModel::ideal();
    model.read = Direction::steady(10, 5);
    model.order = Order::Shuffled;
    let mut seen = [0; 32];
    let mut link = Link::new(model, 5).unwrap();
    for _ in 0..500 {
        let request = ReadRequest { address: 0, tag: 1 };
        assert!(link.cycle(&Requests { read: Some(request), write: None }).read_ready);
        let waited = (1..32).find(|_| link.cycle(&Requests::default()).read.is_some()).unwrap();
        seen[waited] += 1;
    }
    assert!(seen[10..=15].iter().all(|&n| n > 30), "{seen:?}");
    assert_eq!(seen[10..=15].iter().sum::<i32>(), 500);
}

#[test]
fn stalls_close_the_share_they_should() {
    let mut model = LinkModel::ideal();
    model.write.stalls = Stalls { chance: 0.1, longest: 9 };
    let (_, replies) = saturate(model, 11, false, true);
    let open = replies.iter().filter(|reply| reply.write_ready).count() as f64 / CYCLES as f64;
    assert!((open - 0.9 / (0.9 + 0.1 * 5.0)).abs() < 0.02, "{open}");
    assert!(replies.iter().all(|reply| reply.read_ready), "the other direction is left alone");
}

/// Reads lines 0 to 3, which contain their numbers, with tags 10 to 13. Returns (tag, first word, error) in order of
/// arrival.
fn four_reads(faults: &[Fault]) -> Vec<(u16, u32, bool)> {
    let mut link = Link::new(LinkModel::ideal(), 0).unwrap();
    (0..4u32).for_each(|i| link.memory.set(i.into(), &[i; 16]));
    link.plan(faults);
    let mut came = Vec::new();
    for i in 0..12u16 {
        let read = (i < 4).then(|| ReadRequest { address: i.into(), tag: 10 + i });
        came.extend(link.cycle(&Requests { read, write: None }).read.map(|r| (r.tag, r.data[0], r.error)));
    }
    came
}

#[test]
fn faults_do_what_they_say() {
    let right = [(10, 0, false), (11, 1, false), (12, 2, false), (13, 3, false)];
    assert_eq!(four_reads(&[]), right);
    assert_eq!(four_reads(&[Fault::ReadError(2)])[2], (12, 2, true));
    assert_eq!(four_reads(&[Fault::ReadLost(1)]), [right[0], right[2], right[3]]);
    assert_eq!(four_reads(&[Fault::ReadTwice(1)]), [right[0], right[1], right[1], right[2], right[3]]);
    assert_eq!(four_reads(&[Fault::ReadSwapped(1)]), [right[0], (11, 2, false), (12, 1, false), right[3]]);
    assert_eq!(four_reads(&[Fault::ReadFlipped { read: 3, bit: 4 }])[3], (13, 3 ^ 16, false));
}

#[test]
fn failed_writes_are_not_in_memory() {
    let mut link = Link::new(LinkModel::ideal(), 0).unwrap();
    link.plan(&[Fault::WriteError(0), Fault::WriteLost(1), Fault::WriteTwice(2)]);
    let data: Line = [7; 16];
    let mut came = Vec::new();
    for i in 0..6u16 {
        let write = (i < 3).then(|| WriteRequest { address: i.into(), tag: i, data });
        came.extend(link.cycle(&Requests { read: None, write }).write.map(|r| (r.tag, r.error)));
    }
    assert_eq!(came, [(0, true), (2, false), (2, false)]);
    assert_eq!([0, 1, 2].map(|address| link.memory.get(address).is_some()), [false, false, true]);
}

#[test]
fn no_more_is_taken_than_may_be_in_flight() {
    let mut model = LinkModel::ideal();
    model.read = Direction { in_flight: 5, ..Direction::steady(50, 0) };
    model.write = Direction { in_flight: 3, ..model.read };
    let (mut link, mut most) = (Link::new(model, 0).unwrap(), (0, 0));
    for i in 0..400 {
        let read = Some(ReadRequest { address: i, tag: 0 });
        let write = Some(WriteRequest { address: i, tag: 0, data: [0; 16] });
        let room = (link.in_flight().0 < 5, link.in_flight().1 < 3);
        let replies = link.cycle(&Requests { read, write });
        assert!(replies.write_ready <= room.1, "a write beyond what may be in flight");
        assert!(replies.read_ready || !room.0, "a read has room and is refused");
        let now = link.in_flight();
        most = (most.0.max(now.0), most.1.max(now.1));
    }
    assert_eq!(most, (5, 3));
}

#[test]
fn a_geometric_tail_is_mostly_short_and_ends() {
    let mut model = LinkModel::ideal();
    model.read = Direction { shape: Shape::Geometric(4.0), ..Direction::steady(10, 30) };
    model.order = Order::Shuffled;
    let mut link = Link::new(model, 5).unwrap();
    let mut waits = Vec::new();
    for _ in 0..4000 {
        link.cycle(&Requests { read: Some(ReadRequest { address: 0, tag: 1 }), write: None });
        waits.push((1..64).find(|_| link.cycle(&Requests::default()).read.is_some()).unwrap());
    }
    let mean = waits.iter().sum::<usize>() as f64 / waits.len() as f64;
    assert!((mean - 14.0).abs() < 0.3, "{mean}");
    let within = |range: std::ops::RangeInclusive<usize>| waits.iter().filter(|wait| range.contains(wait)).count();
    assert_eq!(within(10..=40), waits.len());
    assert!(within(10..=10) > 600 && within(10..=14) > within(15..=40), "a fifth come at once");
}

#[test]
fn writes_may_have_another_order_than_reads() {
    let mut model = LinkModel::shuffled();
    (model.order, model.write_order) = (Order::InOrder, Some(Order::Shuffled));
    let (_, replies) = saturate(model, 3, true, true);
    let in_order = |tags: Vec<u16>| tags.iter().enumerate().all(|(i, &tag)| usize::from(tag) == i % 1024);
    assert!(in_order(replies.iter().filter_map(|reply| Some(reply.read?.tag)).collect()));
    assert!(!in_order(replies.iter().filter_map(|reply| Some(reply.write?.tag)).collect()));
}

#[test]
fn a_model_s_own_faults_are_there_from_the_start() {
    let model = LinkModel { faults: vec![Fault::ReadError(1)], ..LinkModel::ideal() };
    let mut link = Link::new(model, 0).unwrap();
    let read = |tag| Requests { read: Some(ReadRequest { address: 0, tag }), write: None };
    let errors = [0, 1, 2, 3].map(|tag| link.cycle(&read(tag)).read.map(|reply| reply.error));
    assert_eq!(errors, [None, Some(false), Some(true), Some(false)]);
}
