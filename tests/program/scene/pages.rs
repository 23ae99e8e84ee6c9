//! The page of a scene: its data are those of the run, and the reader's actions change the drawing.

use std::fs;
use std::path::Path;

use contact_afu::scene::{Detector, Plan, Scene, SceneRun, page, query, run};
use serde_json::Value;

use super::scene;

fn results(scene: &Scene) -> SceneRun {
    let plan = Plan::of(scene).unwrap();
    let mut engine = plan.config.profile.reference(plan.config.contact);
    if Plan::moves(scene) {
        run(scene, &plan, Detector::Pairs(&mut engine), "the reference", |_| {}).unwrap()
    } else {
        query(scene, &plan, Detector::Pairs(&mut engine), "the reference").unwrap()
    }
}

/// The data embedded in a page.
fn data(page: &str) -> Value {
    let begin = "<script id=\"picture\" type=\"application/json\">";
    let (_, rest) = page.split_once(begin).expect("the page has its data");
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

/// Decodes base 64.
fn bytes(value: &Value) -> Vec<u8> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits: Vec<u32> = value
        .as_str()
        .expect("a text")
        .bytes()
        .filter(|byte| *byte != b'=')
        .map(|byte| DIGITS.iter().position(|digit| *digit == byte).expect("a digit") as u32)
        .collect();
    let word = |four: &[u32]| (0..4).fold(0, |word, i| word << 6 | four.get(i).copied().unwrap_or(0));
    digits.chunks(4).flat_map(|four| word(four).to_be_bytes()[1..four.len()].to_vec()).collect()
}

fn shorts(value: &Value) -> Vec<u16> {
    bytes(value).chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn places_orientations_and_meetings_in_a_page_are_those_of_the_run() {
    let mut column = scene("column");
    column.steps.value = 150;
    let results = results(&column);
    let data = data(&page(&results, &[]));
    let bodies = results.radii.len();
    assert_eq!(data["frames"], 151);
    assert_eq!(data["every"], 1);
    assert_eq!(number(&data["floor"]), 0.0);
    let (places, turns) = (shorts(&data["places"]), shorts(&data["turns"]));
    assert_eq!(places.len(), 151 * bodies * 3);
    assert_eq!(turns.len(), places.len());
    let span = number(&data["span"]);
    let mut turned = 0.0_f64;
    for (frame, now) in results.places.iter().enumerate() {
        for (body, place) in now.iter().enumerate() {
            for axis in 0..3 {
                let at = (frame * bodies + body) * 3 + axis;
                let value = number(&data["low"][axis]) + f64::from(places[at]) / 65_535.0 * span;
                assert!((value - place[axis]).abs() <= span / 65_535.0, "{frame} {body} {axis}: {value}, {place:?}");
                let part = f32::from(turns[at] as i16) / 32_767.0;
                assert!((part - results.turns[frame][body][axis]).abs() < 1e-4);
                turned = turned.max(f64::from(part).abs());
            }
        }
    }
    assert!(turned > 0.1, "no body turned: {turned}");
    let words: Vec<u32> =
        bytes(&data["meetings"]).chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    assert_eq!(words.len(), results.meetings.len() * 3);
    assert!(!words.is_empty());
    for (three, meeting) in words.chunks_exact(3).zip(&results.meetings) {
        assert_eq!(three, [meeting.step as u32 + 1, meeting.bodies[0] as u32, meeting.bodies[1] as u32]);
        // In the frame before the meeting the bodies were near each other.
        let place = |body: usize| results.places[meeting.step as usize][body];
        let [a, b] = meeting.bodies.map(place);
        let apart = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
        assert!(apart <= meeting.bodies.iter().map(|&body| results.radii[body]).sum::<f64>() * 1.001, "{apart}");
    }
}

#[test]
fn orientations_are_kept_only_where_bodies_turn() {
    let mut gas = scene("gas");
    gas.steps.value = 20;
    let results = results(&gas);
    assert!(results.turns.is_empty() && results.places.len() == 21);
    assert!(data(&page(&results, &[]))["turns"].is_null());
}

/// If there are many bodies, a page draws those that touch and some of the others, so that it stays small.
#[test]
fn a_large_query_makes_a_page_that_is_not() {
    let text = "scene = 1\nname = \"</script><b>\"\nwant = [\"touching\", \"depth\"]\n[[bodies]]\nshape = \"random\"\ncount = 60_000\nseed = 5\n\
                corners = [[-60.0, -60.0, -60.0], [60.0, 60.0, 60.0]]\nradius = 0.4\n";
    let results = results(&Scene::parse("test", text).unwrap());
    let page = page(&results, &[]);
    assert!(page.len() < 2_000_000, "{}", page.len());
    assert!(!page.contains("<b>"), "a name is escaped");
    let data = data(&page);
    let numbers: Vec<usize> = serde_json::from_value(data["numbers"].clone()).unwrap();
    let contacts = data["contacts"].as_array().unwrap();
    assert!(contacts.len() == 1000 && results.contacts.len() > 1000, "{}", results.contacts.len());
    assert!(numbers.len() > 20_000 && numbers.len() < 30_000, "{}", numbers.len());
    for (listed, contact) in contacts.iter().zip(&results.contacts) {
        let body = |place: usize| numbers[listed[place].as_u64().unwrap() as usize];
        assert_eq!([body(1), body(2)], contact.bodies);
        assert_eq!(number(&listed[3][0]) as f32, contact.words[6], "the depth");
    }
}

/// Writes a page without its policy, so that a script of the test can act as its reader.
fn handled(page: &str, hand: &str, to: &Path) {
    let (before, rest) = page.split_once("<meta http-equiv=\"Content-Security-Policy\"").expect("a policy");
    let (_, after) = rest.split_once('>').expect("its end");
    // `look` summarises the canvas: the number of pixels with a bright colour (bodies, not the room), and a sum of all
    // pixels.
    let look = "function look() { const c = document.getElementById('scene'), d = document.createElement('canvas');\
        d.width = 200; d.height = 150; const p = d.getContext('2d'); p.drawImage(c, 0, 0, 200, 150);\
        const v = new Uint32Array(p.getImageData(0, 0, 200, 150).data.buffer);\
        const bright = (w) => { const c = [w & 255, w >> 8 & 255, w >> 16 & 255]; return Math.max(...c) - Math.min(...c) > 70; };\
        return [v.filter(bright).length, v.reduce((s, w) => (s * 31 + w) % 1000003, 7)]; }";
    fs::write(to, format!("{before}{}", after.replace("</body>", &format!("<script>{look}{hand}</script></body>"))))
        .unwrap();
}

fn title(file: &Path) -> Vec<String> {
    let opened = crate::browser::open(file);
    // Chromium warns about reading pixels back, which only this test does.
    let errors: Vec<&String> = opened.console.iter().filter(|line| !line.contains("GPU stall")).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let title = opened.dom.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>")).expect("a title").0;
    title.split('|').map(str::to_owned).collect()
}

#[test]
fn stepping_through_contacts_changes_what_is_shown() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("report.html");
    let made = page(&results(&scene("touching")), &[]);
    fs::write(&file, &made).unwrap();
    let opened = crate::browser::open(&file);
    assert!(opened.console.is_empty() && opened.fetched.is_empty(), "{opened:?}");

    // Every click draws before it returns. The first restores the initial view.
    let hand = "const shown = [], press = (id) => document.getElementById(id).click();\
        const see = () => shown.push(...look(), document.getElementById('which').value);\
        press('reset'); see(); press('next'); see();\
        window.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'})); see(); press('reset'); see();\
        document.title = shown.join('|');";
    handled(&made, hand, &file);
    let seen = title(&file);
    assert_eq!(seen.len(), 12, "{seen:?}");
    let views: Vec<&[String]> = seen.chunks(3).collect();
    assert!(views.iter().all(|view| view[0].parse::<usize>().unwrap() > 50), "no body is seen: {seen:?}");
    assert_eq!(
        views.iter().map(|view| view[2].as_str()).collect::<Vec<_>>(),
        ["none chosen", "1 of 26: 0 and 1376", "2 of 26: 3 and 3904", "none chosen"]
    );
    assert_ne!(views[0][1], views[1][1], "{seen:?}");
    assert_ne!(views[1][1], views[2][1], "{seen:?}");
    assert_eq!(views[0][1], views[3][1], "Reset view shows what was there at first: {seen:?}");
}

#[test]
fn a_moving_scene_moves_and_its_energy_s_curve_leads_to_a_time() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let file = room.path().join("report.html");
    let mut column = scene("column");
    column.steps.value = 60;
    let hand = "const shown = [], at = document.getElementById('at'), curve = document.querySelector('.broad svg.plot');\
        const see = () => shown.push(...look(), document.getElementById('step').value, curve.lastChild.getAttribute('d'));\
        const seek = (value) => { at.value = value; at.dispatchEvent(new Event('input')); see(); };\
        seek('0'); seek('40');\
        window.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowRight'})); see();\
        const box = curve.getBoundingClientRect(), [left, , wide] = curve.dataset.area.split(' ').map(Number);\
        curve.setPointerCapture = () => {};\
        curve.dispatchEvent(new PointerEvent('pointerdown', {pointerId: 1, clientX: box.left + (left + wide / 3) * box.width / 760}));\
        see(); document.title = shown.join('|');";
    handled(&page(&results(&column), &[]), hand, &file);
    let seen = title(&file);
    let views: Vec<&[String]> = seen.chunks(4).collect();
    assert!(views.iter().all(|view| view[0].parse::<usize>().unwrap() > 500), "no body is seen: {seen:?}");
    // The axis ranges from 0 to 0.3. A third of it is a time of 0.1, which is 20 steps of 0.005.
    assert_eq!(
        views.iter().map(|view| view[2].as_str()).collect::<Vec<_>>(),
        ["step 0", "step 40", "step 41", "step 20"]
    );
    for two in views.windows(2) {
        assert!(two[0][1] != two[1][1] && two[0][3] != two[1][3], "the view and the curve follow: {seen:?}");
    }
}
