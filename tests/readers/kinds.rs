//! Every kind of file that is read: valid files, and the functions that read them.

use contact_afu::query::Query;
use std::fs;
use std::path::Path;

use contact_afu::accuracy::trade::{self, Bounds, Time};
use contact_afu::accuracy::{self, HardResults, Task};
use contact_afu::config::{self, Config, Profile, Results, Shell};
use contact_afu::link::{Description, Link, LinkModel};
use contact_afu::query::ContactRecord;
use contact_afu::scene::{Plan, Scene, Still};
use contact_afu::spheres::{self, Search, SphereSet};
use contact_afu::store::{Key, Store};
use contact_afu::sweep::{self, SweepResults};
use contact_afu::synth::{self, Area, Figures};
use contact_afu::{pairs, report};
use serde_json::{Value, json};

use crate::mutate::Form;

/// A kind of file: its name (in a separate folder), valid contents, and a reader that returns true if a file is
/// accepted.
pub struct Kind {
    pub name: &'static str,
    pub form: Form,
    pub seeds: Vec<Vec<u8>>,
    pub read: fn(&Path) -> bool,
}

fn link(path: &Path) -> bool {
    let Ok(text) = fs::read_to_string(path) else { return false };
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let Ok(described) = Description::parse(name, &text) else { return false };
    [1.0, 200.0, 1e6].into_iter().filter_map(|mhz| described.at(mhz).ok()).all(|model| Link::new(model, 1).is_ok())
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn file(name: &str) -> Vec<u8> {
    fs::read(root().join(name)).unwrap()
}

/// The pairs as other supported arrays: binary16 and binary64, big-endian, Fortran order, n × 2 × 4.
fn arrays(pairs: &[contact_afu::query::PairRecord]) -> Vec<Vec<u8>> {
    let array = |descr: &str, order: &str, shape: &str, data: Vec<u8>| {
        let header =
            format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({}, {shape}), }}\n", pairs.len());
        [&b"\x93NUMPY\x01\x00"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes(), &data].concat()
    };
    let values = || pairs.iter().flat_map(|pair| pair.values());
    vec![
        array("<f2", "False", "8", values().flat_map(|value| [value as u8, 0x3C]).collect()),
        array(">f4", "True", "8", values().flat_map(f32::to_be_bytes).collect()),
        array("<f8", "True", "2, 4", values().flat_map(|value| f64::from(value).to_le_bytes()).collect()),
    ]
}

fn of_pairs(room: &Path) -> Vec<Kind> {
    let some = pairs::load(Query::SphereSphere, "random:6", 3).unwrap();
    let contacts: Vec<_> = some.iter().map(|pair| ContactRecord(pair.0)).collect();
    let real = Config::default();
    let real = contact_afu::kernel::Reference::new(real.profile.format(), real.contact).run_all(&some);
    let written = |name: &str, write: &dyn Fn(&Path)| {
        let path = room.join(name);
        write(&path);
        vec![fs::read(path).unwrap()]
    };
    let corpus = file("tb/corpus/hard.csv");
    let lines: Vec<&[u8]> = corpus.split_inclusive(|&byte| byte == b'\n').take(12).collect();
    let pairs = |path: &Path| pairs::read_pairs(Query::SphereSphere, path).is_ok();
    let records = |path: &Path| pairs::read_contacts(path).is_ok();
    let first = SphereSet::Gas(5, 300).spheres(3).first;
    let spheres = |path: &Path| {
        let search = Search::new(Profile::WIDE.arithmetic(), 24).unwrap();
        spheres::read_spheres(path)
            .is_ok_and(|(set, _)| search.candidates(&set, None).counts.invalid <= set.len() as u64)
    };
    vec![
        Kind {
            name: "pairs.csv",
            form: Form::Csv,
            seeds: [
                written("a.csv", &|path| pairs::write_pairs(Query::SphereSphere, path, &some).unwrap()),
                vec![lines.concat()],
            ]
            .concat(),
            read: pairs,
        },
        Kind {
            name: "pairs.npy",
            form: Form::Bytes,
            seeds: [
                written("a.npy", &|path| pairs::write_pairs(Query::SphereSphere, path, &some).unwrap()),
                arrays(&some),
            ]
            .concat(),
            read: pairs,
        },
        Kind {
            name: "sphere_set.csv",
            form: Form::Csv,
            seeds: written("s.csv", &|path| spheres::write_spheres(path, &first).unwrap()),
            read: spheres,
        },
        Kind {
            name: "sphere_set.npy",
            form: Form::Bytes,
            seeds: written("s.npy", &|path| spheres::write_spheres(path, &first).unwrap()),
            read: spheres,
        },
        Kind {
            name: "contacts.csv",
            form: Form::Csv,
            seeds: written("c.csv", &|path| pairs::write_contacts(path, &real).unwrap()),
            read: records,
        },
        Kind {
            name: "contacts.npy",
            form: Form::Bytes,
            seeds: written("c.npy", &|path| pairs::write_contacts(path, &contacts).unwrap()),
            read: records,
        },
    ]
}

/// Files that users write: scenes with the files that they name, link models, lists of Verilog files.
fn of_users(room: &Path) -> Vec<Kind> {
    let models = [LinkModel::hostile(), LinkModel::late()].iter().map(|m| serde_json::to_vec(m).unwrap()).collect();
    // Scenes with spheres in the file under test, and the Verilog files that a list names.
    for name in ["spheres.csv", "spheres.ply"] {
        let scene = format!(
            "scene = 1\nwant = [\"touching\"]\n[[bodies]]\nshape = \"stack\"\ncount = 2\nradius = 1.0\n[[queries]]\n\
             shape = \"file\"\nfile = \"{name}\"\nradius = 0.5\n"
        );
        fs::write(room.join(format!("{name}.toml")), scene).unwrap();
    }
    for name in ["one.v", "two.v"] {
        fs::write(room.join(name), "module m;\nendmodule\n").unwrap();
    }
    let spheres = |path: &Path| {
        let scene =
            Scene::read(&path.with_extension(if path.ends_with("spheres.csv") { "csv.toml" } else { "ply.toml" }));
        scene.is_ok_and(|scene| Still::of(&scene).is_ok())
    };
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float \
               radius\nend_header\n0 1 2 0.5\n3 4 5 1.5\n";
    vec![
        Kind {
            name: "scene.toml",
            form: Form::Toml,
            seeds: ["diamond", "billiards", "column", "touching", "gas"]
                .map(|name| file(&format!("examples/scenes/{name}.toml")))
                .to_vec(),
            read: |path| Scene::read(path).is_ok_and(|scene| Plan::of(&scene).is_ok()),
        },
        Kind {
            name: "spheres.csv",
            form: Form::Csv,
            seeds: vec![b"x,y,z,r\n0,1,2,0.5\n3,4,5,1.5\n".to_vec(), b"x,y,z\n0,1,2\n".to_vec()],
            read: spheres,
        },
        Kind { name: "spheres.ply", form: Form::Bytes, seeds: vec![ply.into()], read: spheres },
        Kind { name: "link.json", form: Form::Json, seeds: models, read: link },
        Kind {
            name: "link.toml",
            form: Form::Toml,
            seeds: vec![file("src/link/presets/harp1.toml"), file("examples/links/lossy.toml")],
            read: link,
        },
        Kind {
            name: "verilog.f",
            form: Form::Bytes,
            seeds: vec![b"// files\none.v\ntwo.v # the other\n".to_vec()],
            read: |path| contact_afu::cosim::Source::from_list(path, "m").is_ok(),
        },
    ]
}

fn swept() -> SweepResults {
    let task = sweep::Task { job: sweep::Job::Pairs(&[]), link: &LinkModel::ideal(), seed: 1, counts: false };
    let swept = sweep::Swept { scpus: vec![1], interval: vec![1], ..sweep::Swept::default() };
    SweepResults::new("random:5", "ideal", &task, &Config::default(), swept)
}

fn measured() -> Key {
    Key::new("area/1", &("wide", 7, 1.5)).unwrap()
}

/// Files that the program writes and reads again: manifests, chosen configurations, studies to be resumed, figures.
fn of_the_program() -> Vec<Kind> {
    let profile = |name: &str| name.parse::<Profile>().unwrap();
    let chosen = [
        Config { scpus: 3, profile: profile("exact"), ..Config::default() },
        Config { profile: profile("e8f15"), shell: Shell::Line, results: Results::Hits, ..Config::default() },
    ];
    let chosen = chosen.map(|config| json!({ "schema": config::MANIFEST_SCHEMA, "config": config }));
    let mut results = trade::committed().unwrap();
    results.points.truncate(2);
    let area = json!({ "luts": 7, "ffs": 5, "dsps": 1, "brams": 0 });
    let mut figures = json!({
        "schema": synth::SCHEMA, "version": "0.1.0", "unit": "add", "profile": "wide", "module": "m", "target": "ecp5",
        "asked_mhz": 200.0, "modelled_mhz": 210.0, "clock_mhz": 190.5, "latency_cycles": 9, "latency_ns": 47.2,
        "wrapper": area, "trimmed": { "inputs": 0, "outputs": 0 }, "seeds": [{ "seed": 1, "clock_mhz": 190.5 }],
        "critical": [{ "signal": "a.b", "stage": 3, "routing_ns": 1.5, "logic_ns": 0.5 }],
        "verilog_sha256": "0", "tools": { "yosys": "y", "nextpnr": "n" },
    });
    figures.as_object_mut().unwrap().extend(area.as_object().unwrap().clone());
    let text = |value: &Value| serde_json::to_vec(value).unwrap();
    let hard = HardResults::new(Task { query: Query::SphereSphere, pairs: 0, seed: 1 }, &["somebody"]);
    vec![
        Kind {
            name: "manifest.json",
            form: Form::Json,
            seeds: [vec![file("rtl/manifest.json")], chosen.iter().map(text).collect()].concat(),
            read: |path| config::read(path).is_ok_and(|config| config.flags().len() < 100),
        },
        Kind {
            name: "results.json",
            form: Form::Json,
            seeds: vec![serde_json::to_vec(&results).unwrap()],
            read: |path| {
                let results = serde_json::from_slice::<trade::Study>(&fs::read(path).unwrap());
                results.is_ok_and(|results| {
                    let bounds = Bounds { error: Some(1e-3), bad: Some(0.0), ..Bounds::default() };
                    let _ = trade::choose(&results, &bounds, Time::Link);
                    !trade::table(&results).is_empty()
                })
            },
        },
        Kind {
            name: "hard/manifest.json",
            form: Form::Json,
            seeds: vec![serde_json::to_vec(&hard).unwrap()],
            read: |path| {
                let task = Task { query: Query::SphereSphere, pairs: 0, seed: 1 };
                let mut results = HardResults::new(task, &[]);
                accuracy::fill(&mut results, &mut [], task, Some((path.parent().unwrap(), false)), |_, _| ()).is_ok()
            },
        },
        Kind {
            name: "sweep/manifest.json",
            form: Form::Json,
            seeds: vec![serde_json::to_vec(&swept()).unwrap()],
            read: |path| swept().check(path.parent().unwrap(), false).is_ok(),
        },
        Kind {
            name: "store/measurement.json",
            form: Form::Json,
            seeds: vec![text(&json!({ "key": measured(), "value": area }))],
            read: |path| {
                // A store looks for a file under the hash of its key.
                let store = Store::open(path.parent().unwrap());
                fs::rename(path, store.file(&measured(), "json")).unwrap();
                store.get::<Area>(&measured()).unwrap().is_some() && store.list().unwrap() == [measured()]
            },
        },
        Kind {
            name: "synth.json",
            form: Form::Json,
            seeds: vec![text(&figures)],
            read: |path| {
                let figures = serde_json::from_slice::<Figures>(&fs::read(path).unwrap());
                figures.is_ok_and(|figures| report::operators::page(&[figures]).is_ok())
            },
        },
    ]
}

/// All kinds. Creates in `room` the folders that kinds name.
pub fn kinds(room: &Path) -> Vec<Kind> {
    for folder in ["hard", "store", "sweep"] {
        fs::create_dir(room.join(folder)).unwrap();
    }
    [of_pairs(room), of_users(room), of_the_program()].into_iter().flatten().collect()
}
