//! The viewer's data: positions and orientations as 16-bit numbers, contacts, and the room around.

use serde::Serialize;

use super::results::SceneRun;
use crate::query::{ContactRecord, FLAGS};
use crate::report::page::base64;

/// The most frames, and the most bytes in all frames together.
const FRAMES: usize = 600;
const BYTES: usize = 3_000_000;
/// The most bodies drawn for a scene without motion, in addition to those of the listed contacts.
const DRAWN: usize = 20_000;
/// The most contacts listed.
pub(super) const LISTED: usize = 1000;
/// Steps of a coordinate across the scene: 16 bits. Those of a quaternion's part: 15 bits and a sign.
const STEPS: f64 = 65_535.0;
const TURN_STEPS: f32 = 32_767.0;

/// The data of a page's viewer.
#[derive(Serialize)]
pub(super) struct Picture {
    /// The number in the scene of every body drawn; `None` if all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub numbers: Option<Vec<usize>>,
    radii: Vec<f32>,
    groups: Vec<usize>,
    queries_from: usize,
    low: [f64; 3],
    span: f64,
    /// The number of frames, and the number of steps from one to the next.
    pub frames: usize,
    pub every: usize,
    time_step: f64,
    /// u16 × 3 per body and frame, from `low`, as shares of `span`: little-endian, in base 64.
    places: String,
    /// i16 × 3 per body and frame: the vector part of a unit quaternion.
    #[serde(skip_serializing_if = "Option::is_none")]
    turns: Option<String>,
    floor: Option<f64>,
    walls: Option<[[f64; 3]; 2]>,
    /// u32 × 3 each: frame, first body, second body.
    meetings: String,
    /// Step, first body, second body, and the fields.
    contacts: Vec<(u64, usize, usize, Vec<f32>)>,
    fields: Vec<&'static str>,
}

impl Picture {
    pub(super) fn of(run: &SceneRun) -> Self {
        let numbers = drawn(run);
        let body_numbers = || numbers.clone().unwrap_or_else(|| (0..run.radii.len()).collect());
        let shown: Vec<usize> = body_numbers();
        let per_body = if run.turns.is_empty() { 6 } else { 12 };
        let most = FRAMES.min(BYTES / (per_body * shown.len().max(1))).max(2);
        let every = run.places.len().saturating_sub(1).div_ceil(most - 1).max(1);
        let frames: Vec<usize> = (0..run.places.len()).step_by(every).collect();
        let (low, span) = extent(run, &frames, &shown);
        let (mut places, mut turns) = (Vec::new(), Vec::new());
        for &frame in &frames {
            for &body in &shown {
                let place = run.places[frame][body];
                for axis in 0..3 {
                    places.extend((((place[axis] - low[axis]) / span * STEPS).round() as u16).to_le_bytes());
                }
                for part in run.turns.get(frame).map_or([0.0; 3], |turns| turns[body]) {
                    turns.extend(((part * TURN_STEPS).round() as i16).to_le_bytes());
                }
            }
        }
        // A meeting in a step is shown in the first frame after it.
        let frame_of = |step: u64| (step as usize + 1).div_ceil(every);
        let meetings = run.meetings.iter().filter(|meeting| frame_of(meeting.step) < frames.len());
        let meetings: Vec<u8> = meetings
            .flat_map(|meeting| [frame_of(meeting.step), meeting.bodies[0], meeting.bodies[1]])
            .flat_map(|number| (number as u32).to_le_bytes())
            .collect();
        let words: Vec<usize> = ContactRecord::words(run.config.contact).filter(|word| *word != FLAGS).collect();
        let place = |body: usize| numbers.as_ref().map_or(Ok(body), |all| all.binary_search(&body)).unwrap_or(0);
        let contacts = run.contacts.iter().take(LISTED).map(|contact| {
            let [first, second] = contact.bodies.map(place);
            (contact.step, first, second, words.iter().map(|&word| contact.words[word]).collect())
        });
        Self {
            radii: shown.iter().map(|&body| run.radii[body] as f32).collect(),
            groups: shown.iter().map(|&body| run.groups[body]).collect(),
            queries_from: shown.partition_point(|&body| body < run.queries_from),
            low,
            span,
            frames: frames.len(),
            every,
            time_step: run.time_step,
            places: base64(&places),
            turns: (!run.turns.is_empty()).then(|| base64(&turns)),
            floor: run.floor,
            walls: run.walls,
            meetings: base64(&meetings),
            contacts: contacts.collect(),
            fields: words.iter().map(|&word| ContactRecord::NAMES[word]).collect(),
            numbers,
        }
    }

    /// The data as JSON text that is safe inside a `script` element, because it cannot end that element.
    pub(super) fn json(&self) -> String {
        serde_json::to_string(self).map_or_else(|_| "null".to_owned(), |text| text.replace('<', "\\u003c"))
    }
}

/// The bodies drawn, in order, or `None` if all are: those of the listed contacts, and a regular sample of the others.
fn drawn(run: &SceneRun) -> Option<Vec<usize>> {
    let all = run.radii.len();
    if all <= DRAWN {
        return None;
    }
    let mut shown: Vec<usize> = run.contacts.iter().take(LISTED).flat_map(|contact| contact.bodies).collect();
    shown.extend((0..all).step_by(all.div_ceil(DRAWN)));
    shown.sort_unstable();
    shown.dedup();
    Some(shown)
}

/// The lowest corner of all bodies in these frames, and the longest side of their box.
fn extent(run: &SceneRun, frames: &[usize], shown: &[usize]) -> ([f64; 3], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for place in frames.iter().flat_map(|&frame| shown.iter().map(move |&body| run.places[frame][body])) {
        for axis in 0..3 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    (low, (0..3).map(|axis| high[axis] - low[axis]).fold(f64::MIN_POSITIVE, f64::max))
}
