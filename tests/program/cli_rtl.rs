//! `afu rtl`: the files it writes, the folders it refuses, and unsupported options.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn afu(folder: &Path, arguments: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("afu").expect("the program is built").current_dir(folder).args(arguments).assert()
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("UTF-8")
}

fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("readable");
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() {
            files.extend(contents(&entry.path()).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            files.insert(name, fs::read(entry.path()).expect("readable"));
        }
    }
    files
}

#[test]
fn a_package_is_whole_and_the_same_every_time() {
    let room = tempfile::tempdir().expect("a temporary folder");
    afu(room.path(), &["rtl", "--out", "a"]).success();
    afu(room.path(), &["rtl", "--scpus", "10", "--out", "b"]).success();
    let (a, b) = (contents(&room.path().join("a")), contents(&room.path().join("b")));
    assert_eq!(a, b, "the same configuration gives the same bytes");

    let manifest: serde_json::Value = serde_json::from_slice(&a["manifest.json"]).expect("JSON");
    let hashed = manifest["files"].as_object().expect("hashes");
    let mut named: Vec<&str> = a.keys().map(String::as_str).filter(|name| *name != "manifest.json").collect();
    named.sort_unstable();
    assert!(named.iter().eq(hashed.keys().collect::<Vec<_>>().iter()), "every file has its hash");
    let list = String::from_utf8(a["contact_afu.f"].clone()).expect("UTF-8");
    let mut files = list.lines().filter(|line| !line.starts_with("//"));
    assert!(list.lines().count() > 10 && files.all(|file| a.contains_key(file)), "{list}");
    for name in ["contact_afu.core", "contact_afu.sdc", "contact_afu.xdc", "PORTS.md", "sim/afu_top_bench.v"] {
        assert!(a.contains_key(name), "{name}");
    }
}

#[test]
fn a_manifest_is_a_configuration_and_flags_win_over_it() {
    let room = tempfile::tempdir().expect("a temporary folder");
    afu(room.path(), &["rtl", "--scpus", "3", "--profile", "paper", "--contact", "hit,depth", "--out", "a"]).success();
    afu(room.path(), &["rtl", "--config", "a/manifest.json", "--out", "b"]).success();
    assert_eq!(contents(&room.path().join("a")), contents(&room.path().join("b")));
    afu(room.path(), &["rtl", "--config", "a", "--scpus", "5", "--out", "c"]).success();
    let text = fs::read(room.path().join("c/manifest.json")).expect("written");
    let manifest: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!((&manifest["config"]["scpus"], &manifest["config"]["profile"]), (&5.into(), &"paper".into()));
}

#[test]
fn records_of_16_bits_are_told_of_everywhere() {
    let room = tempfile::tempdir().expect("a temporary folder");
    afu(room.path(), &["rtl", "--shell", "line", "--interval", "1", "--record", "bf16", "--out", "a"]).success();
    let files = contents(&room.path().join("a"));
    let manifest: serde_json::Value = serde_json::from_slice(&files["manifest.json"]).expect("JSON");
    assert_eq!(manifest["config"]["record"], "bf16");
    assert_eq!((&manifest["records"]["pair_bits"], &manifest["records"]["pairs_per_line"]), (&128.into(), &4.into()));
    let ports = String::from_utf8_lossy(&files["PORTS.md"]).into_owned();
    assert!(ports.contains("27:26 are 2: words of records are bf16"), "{ports}");
    let top = String::from_utf8_lossy(&files["scpu.v"]).into_owned();
    assert!(top.contains("--record bf16"), "{top}");
    afu(room.path(), &["rtl", "--config", "a", "--record", "f32", "--out", "b"]).success();
    afu(room.path(), &["rtl", "--shell", "line", "--interval", "1", "--out", "c"]).success();
    assert_eq!(
        contents(&room.path().join("b")),
        contents(&room.path().join("c")),
        "f32 is the default, and not told of"
    );
}

/// Roots and reciprocals use tables, or digit recurrence to save multiplier blocks.
#[test]
fn multiplier_blocks_can_be_spared() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let rtl = ["rtl", "--shell", "line", "--interval", "1", "--out"];
    afu(room.path(), &[&rtl[..], &["used"]].concat()).success();
    afu(room.path(), &[&rtl[..], &["spared", "--multipliers", "spare"]].concat()).success();
    let [used, spared] = ["used", "spared"].map(|folder| contents(&room.path().join(folder)));
    let says = |files: &BTreeMap<String, Vec<u8>>, file: &str, what: &str| {
        String::from_utf8_lossy(&files[file]).contains(what)
    };
    for root in ["fp_sqrt_e10f23z_normal.v", "fp_recip_e10f23z_normal.v"] {
        assert!(says(&used, root, "piece_begin") && !says(&spared, root, "piece_begin"), "{root}");
        assert!(!says(&used, root, "partial_1") && says(&spared, root, "partial_1"), "{root}");
    }
    let manifest: serde_json::Value = serde_json::from_slice(&spared["manifest.json"]).expect("JSON");
    assert_eq!(manifest["config"]["multipliers"], "spare");
    assert!(says(&spared, "scpu.v", "--multipliers spare"));
    afu(room.path(), &["rtl", "--config", "spared", "--multipliers", "use", "--out", "again"]).success();
    assert_eq!(contents(&room.path().join("again")), used, "use is the default, and not told of");
}

#[test]
fn a_folder_of_somebody_else_is_refused_without_force() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let theirs = room.path().join("theirs");
    fs::create_dir(&theirs).expect("made");
    fs::write(theirs.join("thesis.txt"), "years of work").expect("written");
    let refused = afu(room.path(), &["rtl", "--out", "theirs"]).code(2);
    assert!(said(&refused).contains("theirs") && said(&refused).contains("--force"), "{}", said(&refused));
    assert_eq!(contents(&theirs).len(), 1);

    afu(room.path(), &["rtl", "--out", "theirs", "--force"]).success();
    assert!(!theirs.join("thesis.txt").exists() && theirs.join("contact_afu.v").exists());
    afu(room.path(), &["rtl", "--scpus", "2", "--out", "theirs"]).success();
    assert_eq!(fs::read_dir(room.path()).expect("there").count(), 1, "nothing is left aside");
}

#[test]
fn what_is_out_of_range_is_one_line_and_exit_2() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (arguments, word) in [
        (["--interval", "65"], "interval 65"),
        (["--interval", "fast"], "--interval fast"),
        (["--bus", "256"], "bus of 256 bits below shell spl2"),
        (["--target", "tin"], "tin"),
        // There is no Verilog for these targets, and the program does not write any other in its place.
        (["--target", "cyclonev"], "`afu synth --target cyclonev` estimates the area"),
        (["--target", "xilinx"], "`afu synth --target xilinx` estimates the area"),
        (["--scpus", "0"], "0 SCPUs"),
        (["--scpus", "65"], "65 SCPUs"),
        (["--clock", "0"], "clock 0"),
        (["--clock", "inf"], "clock inf"),
        (["--config", "absent.json"], "absent.json"),
        (["--radius", "-1"], "radius -1"),
    ] {
        let refused = afu(room.path(), &[&["rtl", "--out", "out"][..], &arguments].concat()).code(2);
        let said = said(&refused);
        assert!(said.starts_with("afu: ") && said.lines().count() == 1 && said.contains(word), "{said}");
    }
    let refused = afu(room.path(), &["rtl", "--out", "out", "--input", "indexed"]).code(2);
    assert!(said(&refused).contains("unknown input `indexed`: use direct"), "{}", said(&refused));
    for (arguments, word) in [
        (["--profile", "exact", "--record", "f16"], "profile exact with record f16"),
        (["--radius", "1e6", "--record", "f16"], "radius 1000000: infinite in f16 records"),
    ] {
        let refused = afu(room.path(), &[&["rtl", "--out", "out"][..], &arguments].concat()).code(2);
        let said = said(&refused);
        assert!(said.starts_with("afu: ") && said.lines().count() == 1 && said.contains(word), "{said}");
    }
    for arguments in [
        ["--record", "f8"],
        ["--profile", "exactly"],
        ["--contact", "mass"],
        ["--multipliers", "save"],
        ["--shell", "pcie"],
        ["--scpus", "ten"],
    ] {
        afu(room.path(), &[&["rtl", "--out", "out"][..], &arguments].concat()).code(2);
    }
    assert_eq!(fs::read_dir(room.path()).expect("there").count(), 0, "nothing is written");
}

/// At an interval of 5 ten SCPUs take one line per cycle, which is the limit of an ideal link. On a slower link the
/// interval may be longer.
#[test]
fn interval_auto_is_what_the_link_needs() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let interval = |arguments: &[&str]| {
        let all = [&["rtl", "--out", "out", "--force", "--profile", "half"][..], arguments].concat();
        afu(room.path(), &all).success();
        let manifest = fs::read_to_string(room.path().join("out/manifest.json")).expect("written");
        let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
        manifest["config"]["interval"].as_u64().expect("a number")
    };
    assert_eq!(interval(&[]), 5, "nothing said is auto");
    assert_eq!(interval(&["--interval", "auto"]), 5);
    assert_eq!(interval(&["--interval", "3"]), 3);
    fs::write(
        room.path().join("c.json"),
        r#"{"schema": "contact-afu/rtl/1", "config": {"interval": 2, "profile": "half"}}"#,
    )
    .expect("written");
    assert_eq!(interval(&["--config", "c.json"]), 2, "a file has said it");
    assert_eq!(interval(&["--config", "c.json", "--interval", "auto"]), 5);
    assert_eq!(interval(&["--scpus", "1"]), 1);
    assert_eq!(interval(&["--scpus", "16"]), 8);
    assert!(interval(&["--link", "harp1"]) > 5);
    let refused = afu(room.path(), &["rtl", "--out", "new", "--interval", "auto", "--link", "none"]).code(2);
    assert!(said(&refused).contains("none"), "{}", said(&refused));
}

/// Every module and file name starts with the prefix. `afu cosim --rtl` finds the top module of such a folder.
#[test]
fn a_prefix_is_before_every_name() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let options = ["--profile", "half", "--contact", "hit", "--scpus", "1", "--shell", "line"];
    afu(room.path(), &[&["rtl", "--prefix", "left", "--out", "a"][..], &options].concat()).success();
    let files = contents(&room.path().join("a"));
    for (name, text) in files.iter().filter(|(name, _)| name.ends_with(".v")) {
        let text = String::from_utf8_lossy(text);
        let module = text.lines().find_map(|line| line.strip_prefix("module ")).expect("a module");
        let stem = name.trim_end_matches(".v").trim_start_matches("sim/");
        assert!(
            stem.starts_with("left_") && module.trim_end_matches(';').split(' ').next() == Some(stem),
            "{name}: {module}"
        );
    }
    let manifest: serde_json::Value = serde_json::from_slice(&files["manifest.json"]).expect("JSON");
    for operator in manifest["kernel"]["operators"].as_array().expect("a list") {
        let file = format!("{}.v", operator["module"].as_str().expect("a name"));
        assert!(files.contains_key(&file), "{file}");
    }
    afu(room.path(), &["rtl", "--config", "a", "--out", "b"]).success();
    assert_eq!(files, contents(&room.path().join("b")), "a manifest has the prefix");
    #[cfg(feature = "cosim")]
    afu(room.path(), &["cosim", "--rtl", "a", "--pairs", "random:40"]).success();
    let refused = afu(room.path(), &["rtl", "--prefix", "2x", "--out", "c"]).code(2);
    assert!(said(&refused).contains("prefix `2x`"), "{}", said(&refused));
}

#[test]
fn scpus_that_are_not_built_are_warned_of() {
    let room = tempfile::tempdir().expect("a temporary folder");
    for (scpus, warning) in [("10", ""), ("11", "11 SCPUs at interval 5: 10 of them can take turns"), ("20", "")] {
        let options = ["rtl", "--profile", "half", "--interval", "5", "--scpus", scpus, "--out", "out"];
        let said = said(&afu(room.path(), &options).success());
        assert!(if warning.is_empty() { said.is_empty() } else { said.contains(warning) }, "{scpus}: {said}");
        let ports = fs::read_to_string(room.path().join("out/PORTS.md")).expect("written");
        assert!(ports.contains("above 10 the number built is"), "{ports}");
    }
}

/// With a target, the Verilog instantiates its blocks by name, and the manifest says so. A simulator reads the same
/// AFU.
#[test]
fn a_target_s_blocks_are_named() {
    let room = tempfile::tempdir().expect("a temporary folder");
    afu(room.path(), &["rtl", "--interval", "1", "--out", "plain"]).success();
    afu(room.path(), &["rtl", "--interval", "1", "--out", "ecp5", "--target", "ecp5"]).success();
    let [plain, ecp5] = ["plain", "ecp5"].map(|folder| contents(&room.path().join(folder)));
    let named = |files: &BTreeMap<String, Vec<u8>>, block: &str| {
        let text = |bytes: &Vec<u8>| String::from_utf8(bytes.clone()).expect("text");
        files.values().filter(|bytes| text(bytes).contains(&format!("  {block} #("))).count()
    };
    for block in ["MULT18X18D", "DP16KD", "CCU2C"] {
        assert!(named(&ecp5, block) > 0 && named(&plain, block) == 0, "{block}");
    }
    let primitives = |files: &BTreeMap<String, Vec<u8>>| {
        let manifest: serde_json::Value = serde_json::from_slice(&files["manifest.json"]).expect("JSON");
        manifest["primitives"].clone()
    };
    assert_eq!(primitives(&ecp5), serde_json::json!(["CCU2C", "DP16KD", "MULT18X18D"]));
    assert!(primitives(&plain).is_null());
    afu(room.path(), &["rtl", "--interval", "1", "--out", "ice40", "--target", "ice40"]).success();
    let ice40 = contents(&room.path().join("ice40"));
    let top = |files: &BTreeMap<String, Vec<u8>>| String::from_utf8_lossy(&files["contact_afu.v"]).into_owned();
    let named = [(&plain, None), (&ecp5, Some("ecp5")), (&ice40, Some("ice40"))];
    for (files, target) in named {
        let manifest: serde_json::Value = serde_json::from_slice(&files["manifest.json"]).expect("JSON");
        assert_eq!(manifest["target"].as_str(), target);
        assert_eq!(top(files).contains("--target"), target.is_some(), "the command in the header is whole");
    }
    // Memories request what the family has: no named Intel block for these targets, and MLAB only where Quartus may
    // read the Verilog.
    let asks = |files: &BTreeMap<String, Vec<u8>>, word: &str| {
        files.iter().any(|(name, bytes)| name.ends_with(".v") && String::from_utf8_lossy(bytes).contains(word))
    };
    for (files, target) in named {
        assert!(!["M9K", "M10K", "M20K"].iter().any(|block| asks(files, block)), "{target:?}");
        assert_eq!(asks(files, "ramstyle"), target.is_none(), "{target:?}");
        assert_eq!(asks(files, "ram_style = \"distributed\""), target != Some("ice40"), "{target:?}");
    }
}

/// Packages are files more, with their hashes in the manifest. They name what cannot be tried here.
#[test]
fn packages_are_for_shells_with_buses() {
    let room = tempfile::tempdir().expect("a temporary folder");
    let options = ["rtl", "--shell", "axi", "--bus", "128", "--profile", "half", "--prefix", "left", "--out"];
    afu(room.path(), &[&options[..], &["plain"]].concat()).success();
    afu(room.path(), &[&options[..], &["packed", "--package", "ipxact,fusesoc,litex"]].concat()).success();
    let [plain, packed] = ["plain", "packed"].map(|folder| contents(&room.path().join(folder)));
    let added: Vec<&str> = packed.keys().filter(|name| !plain.contains_key(*name)).map(String::as_str).collect();
    assert_eq!(added, ["component.xml", "left_contact_afu_litex.py", "package_xo.tcl"]);
    assert!(plain.iter().all(|(name, bytes)| name == "manifest.json" || packed[name] == *bytes));
    let text = |name: &str| String::from_utf8_lossy(&packed[name]).into_owned();
    let manifest: serde_json::Value = serde_json::from_slice(&packed["manifest.json"]).expect("JSON");
    assert!(added.iter().all(|name| manifest["files"][name].is_string()), "{manifest}");
    for name in ["component.xml", "package_xo.tcl"] {
        assert!(text(name).contains("UNTESTED: no Vivado") && text(name).contains("left_contact_afu_axi"), "{name}");
    }
    // The arguments of the kernel, at the offsets of REGISTERS.md.
    for row in ["CTRL 0x000 32", "source 0x010 64 m_axi_gmem", "destination 0x018 64 m_axi_gmem", "count 0x020 32"] {
        assert!(text("package_xo.tcl").contains(&format!("kernel_register $block {row}\n")), "{row}");
    }
    assert!(!text("package_xo.tcl").contains("scratch"));
    assert!(!text("left_contact_afu_litex.py").contains('@'), "every value is filled in");
    // Of an AFU that takes spheres, with the argument that it has beside these, and without SCPUs.
    let options = ["rtl", "--input", "spheres", "--shell", "axi", "--package", "ipxact,litex", "--out", "spheres"];
    afu(room.path(), &options).success();
    let packed = contents(&room.path().join("spheres"));
    let has = |name: &str, text: &str| String::from_utf8_lossy(&packed[name]).contains(text);
    assert!(has("package_xo.tcl", "kernel_register $block others 0x030 32\n") && has("component.xml", ">candidates<"));
    assert!(packed.keys().all(|name| name == "manifest.json" || !has(name, "SCPUS")));
    assert!(has("contact_afu_litex.py", "def __init__(self, platform, address_width=32)"));
    for shell in ["spl2", "line"] {
        for package in ["ipxact", "litex"] {
            let arguments = ["rtl", "--shell", shell, "--package", package, "--out", "none"];
            let refused = said(&afu(room.path(), &arguments).code(2));
            let expected = format!("afu: package {package} of shell {shell}: only shell axi has buses");
            assert!(refused.starts_with(&expected) && refused.lines().count() == 1, "{refused}");
        }
    }
    afu(room.path(), &["rtl", "--package", "fusesoc", "--profile", "half", "--out", "core"]).success();
    assert!(!room.path().join("none").exists());
}
