use contact_afu::afu::{Afu, Spec};
use contact_afu::config::Config;
use contact_afu::cosim::*;
use contact_afu::hdl::DelayModel;
use contact_afu::kernel::*;
use contact_afu::link::*;
use contact_afu::number::Format;
use contact_afu::pairs;
use contact_afu::pipeline::{Settings, sphere_kernel};
#[test]
fn write() {
    let spec = Spec::from(Config::default());
    let kernel = sphere_kernel(&Settings {
        arithmetic: Format::WIDE,
        record: Format::BINARY32,
        fields: spec.config.contact,
        clock_mhz: 200.0,
        model: DelayModel::default(),
    })
    .unwrap();
    let afu = Afu::around(spec, kernel).unwrap();
    std::fs::create_dir_all("/tmp/rtl").unwrap();
    for (name, text) in afu.files() {
        std::fs::write(format!("/tmp/rtl/{name}"), text).unwrap();
    }
    let files = afu.verilog().into_iter().map(|(name, text)| File { name, text }).collect();
    let source = Source::new("contact_afu", files);
    assert_eq!(source.sha256(), afu.rtl_sha256());
    let reference = Reference::new(Format::WIDE, Fields::ALL);
    let mut recs: Vec<PairRecord> = vec![];
    for i in -9i32..=9 {
        for j in -9i32..=9 {
            for k in -9i32..=9 {
                recs.push(PairRecord::from_spheres(
                    [0., 0., 0., 0.5],
                    [i as f32 * 0.3, j as f32 * 0.3, k as f32 * 0.3, 0.5],
                ));
            }
        }
    }
    for n in [1u64, 10, 16] {
        let t = cpu();
        let model = Model::build(&source.clone().parameter("SCPUS", n), Trace::Off).unwrap();
        let built = cpu() - t;
        for link in LinkModel::PRESETS {
            let instance = model.instance(5).unwrap();
            let mut driver = Driver::new(&instance, Link::new(link.parse().unwrap(), 1).unwrap()).unwrap();
            let lines: Vec<Line> = recs
                .chunks(2)
                .map(|c| {
                    let mut l = [0; 16];
                    for (i, r) in c.iter().enumerate() {
                        l[8 * i..8 * i + 8].copy_from_slice(&r.0);
                    }
                    l
                })
                .collect();
            let t = cpu();
            let o = driver
                .run(&Job {
                    scpus: Some(n as u32),
                    ..Job::new(&lines, recs.len() as u32, recs.len().div_ceil(2) as u64)
                })
                .unwrap();
            let el = std::time::Duration::from_secs_f64(cpu() - t);
            let got: Vec<ContactRecord> = o
                .lines
                .iter()
                .flat_map(|l| {
                    let l = l.unwrap();
                    [ContactRecord(l[..8].try_into().unwrap()), ContactRecord(l[8..].try_into().unwrap())]
                })
                .take(recs.len())
                .collect();
            let want = reference.run_all(&recs);
            let bad = got.iter().zip(&want).filter(|(a, b)| a != b).count();
            println!(
                "N={n} {link}: built {built:.1}, {} pairs, {} cycles, {:.3} c/pair, eff {:.3}, lat {:?} busy {} in {} out {} contacts {} invalid {}; mismatches {bad}; {:.0} cycles/s",
                recs.len(),
                o.cycles,
                o.cycles as f64 / recs.len() as f64,
                o.efficiency(),
                o.latency_cycles,
                o.cycles_busy,
                o.cycles_input,
                o.cycles_output,
                o.contacts,
                o.invalid,
                o.cycles as f64 / el.as_secs_f64()
            );
        }
    }
}

fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    s.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-9
}
