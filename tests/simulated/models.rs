//! Building, loading and stepping Verilated models.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::{env, fs, thread};

use contact_afu::cosim::{CosimError, File, Instance, Model, SimulationError, Source, Trace};

fn echo() -> Source {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/echo");
    Source::from_folder(&folder, "contact_afu").unwrap()
}

fn module(text: &str) -> Source {
    Source::new("top", vec![File { name: "top.v".into(), text: text.into() }])
}

/// An eight-bit counter, with additional text from a test.
fn counter(more: &str) -> Source {
    module(&format!(
        "module top (input wire clk, input wire rst, output reg [7:0] count);\n\
         always @(posedge clk) count <= rst ? 8'd0 : count + 8'd1;\n{more}\nendmodule\n"
    ))
}

/// Resets the counter, lets it run, and returns its value.
fn count_to(instance: &Instance, cycles: u64) -> u64 {
    let (clk, rst) = (instance.clock("clk").unwrap(), instance.input("rst", 1).unwrap());
    rst.set(1);
    clk.tick(1).unwrap();
    rst.set(0);
    clk.tick(cycles).unwrap();
    instance.output("count", 8).unwrap().get()
}

#[test]
fn ports_are_found_and_carry_values() {
    let model = Model::build(&echo().parameter("SCPUS", 7), Trace::Off).unwrap();
    let afu = model.instance(1).unwrap();
    let (clk, rst) = (afu.clock("clk").unwrap(), afu.input("rst", 1).unwrap());
    let capability = afu.output("capability", 64).unwrap();
    rst.set(1);
    clk.tick(2).unwrap();
    rst.set(0);
    clk.tick(1).unwrap();
    assert_eq!(capability.get() & 0xff, 7);
    assert!(!afu.output("done", 1).unwrap().is_high());
}

#[test]
fn every_width_goes_in_and_out_and_no_further() {
    let model = Model::build(
        &module(
            "module top (input wire [7:0] a, input wire [9:0] b, input wire [31:0] c, input wire [57:0] d,\n\
             input wire [127:0] e, output wire [7:0] na, output wire [9:0] nb, output wire [31:0] nc,\n\
             output wire [57:0] nd, output wire [127:0] ne);\n\
             assign na = ~a; assign nb = ~b; assign nc = ~c; assign nd = ~d; assign ne = ~e;\nendmodule\n",
        ),
        Trace::Off,
    )
    .unwrap();
    let top = model.instance(0).unwrap();
    for (input, output, bits) in [("a", "na", 8), ("b", "nb", 10), ("c", "nc", 32), ("d", "nd", 58)] {
        let (input, output) = (top.input(input, bits).unwrap(), top.output(output, bits).unwrap());
        let mask = u64::MAX >> (64 - bits);
        for value in [0, 1, 0x5555_5555_5555_5555, u64::MAX] {
            input.set(value);
            top.evaluate().unwrap();
            assert_eq!((input.get(), output.get()), (value & mask, !value & mask), "{bits} bits");
        }
    }
    let (input, output) = (top.input("e", 128).unwrap(), top.output("ne", 128).unwrap());
    input.set_words(&[1, 2, 3, u32::MAX]);
    top.evaluate().unwrap();
    assert_eq!((output.words(), output.get()), ([!1, !2, !3, 0], !0x0000_0002_0000_0001));
}

#[test]
fn a_port_that_does_not_fit_is_named() {
    let model = Model::build(&echo(), Trace::Off).unwrap();
    let afu = model.instance(0).unwrap();
    let text = |error: SimulationError| error.to_string();
    assert_eq!(
        text(afu.input("rd_rsp_tag", 9).unwrap_err()),
        "port `rd_rsp_tag`: expected an input of 9 bits, found an input of 10 bits in the model"
    );
    assert_eq!(
        text(afu.output("rd_rsp_tag", 10).unwrap_err()),
        "port `rd_rsp_tag`: expected an output of 10 bits, found an input of 10 bits in the model"
    );
    assert_eq!(
        text(afu.input("nothing", 1).unwrap_err()),
        "port `nothing`: expected an input of 1 bits, found no such port in the model"
    );
    assert!(afu.output("wr_req_data", 256).is_err() && afu.clock("count").is_err());
}

#[test]
fn a_generated_afu_and_its_source_have_one_hash() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rtl");
    let source = Source::from_folder(&folder, "contact_afu").unwrap();
    let manifest = fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(manifest["rtl_sha256"], source.sha256());
    if let Some(model) = Model::built_in() {
        assert_eq!(model.rtl_sha256(), source.sha256());
    }
}

/// Models with different flags contain different versions of Verilator's runtime under the same names. Each must use
/// its own.
#[test]
fn models_live_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let plain = Model::build(&counter(""), Trace::Off).unwrap();
    let traced = Model::build(&counter(""), Trace::Vcd).unwrap();
    let by_two = Model::build(&module(&counter("").files()[0].text.replace("8'd1", "8'd2")), Trace::Vcd).unwrap();
    assert_eq!((plain.trace(), traced.trace()), (Trace::Off, Trace::Vcd));
    let built_in = Model::built_in().map(|model| model.instance(1).unwrap());
    let instances = [&plain, &traced, &by_two, &plain].map(|model| model.instance(1).unwrap());
    let waveforms = [1, 2].map(|i| folder.path().join(format!("{i}.vcd")));
    for (instance, path) in instances[1..3].iter().zip(&waveforms) {
        instance.trace_open(path, 2500).unwrap();
    }
    for (instance, expected) in instances.iter().zip([10, 10, 20, 10]) {
        assert_eq!(count_to(instance, 10), expected);
    }
    if let Some(afu) = &built_in {
        assert!(afu.has_port("afu_tx_wr_hdr"), "the built-in model is still itself");
    }
    for (instance, path) in instances[1..3].iter().zip(&waveforms) {
        instance.trace_close().unwrap();
        let text = fs::read_to_string(path).unwrap();
        assert!(text.contains("$var") && text.contains("count") && text.contains("#5000"), "{text}");
    }
}

#[test]
fn a_waveform_can_follow_another_and_without_tracing_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let instance = Model::build(&counter(""), Trace::Vcd).unwrap().instance(0).unwrap();
    for name in ["first.vcd", "second.vcd"] {
        instance.trace_open(&path(name), 500).unwrap();
        assert!(instance.trace_open(&path("other.vcd"), 500).is_err(), "one at a time");
        count_to(&instance, 3);
        instance.trace_close().unwrap();
        let text = fs::read_to_string(path(name)).unwrap();
        assert!(text.contains("b00000011"), "{name} begins with a full picture and has every change: {text}");
    }
    assert!(instance.trace_close().is_err());
    let error = instance.trace_open(Path::new("/nowhere/at/all.vcd"), 500).unwrap_err();
    assert!(error.to_string().contains("/nowhere/at/all.vcd"), "{error}");
    let plain = Model::build(&counter(""), Trace::Off).unwrap().instance(0).unwrap();
    let error = plain.trace_open(&path("none.vcd"), 500).unwrap_err().to_string();
    assert!(error.contains("built without waveforms"), "{error}");
}

/// If a waveform cannot be written, the error names the file. No file is left, and the process does not end.
#[test]
fn a_waveform_on_a_full_disk_is_an_error_and_no_file() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    for (trace, name) in [(Trace::Vcd, "wave.vcd"), (Trace::Fst, "wave.fst")] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        symlink("/dev/full", &path).unwrap();
        let Ok(model) = Model::build(&counter(""), trace) else { continue }; // the libraries of FST are missing
        let instance = model.instance(0).unwrap();
        instance.trace_open(&path, 500).unwrap();
        count_to(&instance, 100);
        let error = instance.trace_close().unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("No space left on device"), "{error}");
        assert!(fs::metadata(&path).unwrap().file_type().is_char_device(), "{name} is what it was");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{name}");
        // The model continues, and a second, small enough waveform can follow.
        fs::remove_file(&path).unwrap();
        instance.trace_open(&path, 500).unwrap();
        instance.clock("clk").unwrap().tick(100).unwrap();
        assert!(!path.exists(), "{name} is there whole or not at all");
        instance.trace_close().unwrap();
        assert!(fs::metadata(&path).unwrap().len() > 100, "{name}");
    }
}

#[test]
fn fst_is_written_where_its_libraries_are() {
    let folder = tempfile::tempdir().unwrap();
    match Model::build(&counter(""), Trace::Fst) {
        Ok(model) => {
            let instance = model.instance(0).unwrap();
            let path = folder.path().join("wave.fst");
            instance.trace_open(&path, 500).unwrap();
            count_to(&instance, 100);
            instance.trace_close().unwrap();
            assert!(fs::metadata(&path).unwrap().len() > 100);
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains("zlib") || text.contains("lz4") || text.contains("-lz"), "{text}");
        }
    }
}

#[test]
fn what_no_reset_reaches_is_random_by_the_seed() {
    let source = module(
        "module top (input wire clk, output reg [31:0] kept);\nalways @(posedge clk) kept <= kept;\nendmodule\n",
    );
    let model = Model::build(&source, Trace::Off).unwrap();
    let kept = |seed| {
        let instance = model.instance(seed).unwrap();
        instance.clock("clk").unwrap().tick(1).unwrap();
        instance.output("kept", 32).unwrap().get()
    };
    assert_eq!(kept(0), 0);
    assert_eq!(kept(1), kept(1));
    assert!(kept(1) != kept(2) && kept(1) != 0);
}

#[test]
fn what_ends_a_simulation_is_an_error_and_stays_one() {
    for (ending, says) in [("$finish;", "$finish"), ("$stop;", "$stop"), ("$fatal(1, \"no\");", "$stop")] {
        let source = counter(&format!("always @(posedge clk) if (count == 8'd5) {ending}"));
        let instance = Model::build(&source, Trace::Off).unwrap().instance(0).unwrap();
        let clk = instance.clock("clk").unwrap();
        let error = clk.tick(100).unwrap_err().to_string();
        assert!(error.starts_with("the simulated AFU stopped: ") && error.contains(says), "{error}");
        assert!(error.contains("top.v:3"), "{error}");
        assert_eq!(clk.tick(1).unwrap_err().to_string(), error);
        assert_eq!(instance.output("count", 8).unwrap().get(), 5, "ports can still be read");
    }
}

#[test]
fn bad_verilog_is_refused_with_file_and_line() {
    let refused = |source: &Source| match Model::build(source, Trace::Off) {
        Err(CosimError::Build(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let error = refused(&counter("assign nothing = 1'b1 +;"));
    assert!(error.starts_with("Verilator refused top:\n") && error.contains("top.v:3"), "{error}");
    let error = refused(&counter("wire [3:0] narrow = count;"));
    assert!(error.contains("WIDTH") && error.contains("top.v:3"), "a lint error is an error: {error}");
    assert!(!error.contains("lint_off"), "no advice to write pragmas: {error}");
    let error = refused(&echo().parameter("SCPUS", 65));
    assert!(error.contains("SCPUS must be 1 to 64"), "{error}");
    for bad in [Source::new("no-name", counter("").files().to_vec()), counter("").parameter("a b", 1)] {
        assert!(matches!(Model::build(&bad, Trace::Off), Err(CosimError::Source(_))));
    }
    let outside = vec![File { name: "../x.v".into(), text: String::new() }];
    assert!(matches!(Model::build(&Source::new("top", outside), Trace::Off), Err(CosimError::Source(_))));
    assert!(Source::from_folder(Path::new("/nowhere"), "top").unwrap_err().to_string().contains("/nowhere/top.f"));
}

/// The test below runs in other processes too. The environment tells them their role.
const ROLE: &str = "AFU_TEST_ROLE";

fn in_another_process(test: &str, cache: &Path, variables: &[(&str, &str)]) -> Child {
    let mut command = Command::new(env::current_exe().unwrap());
    command.args([&format!("models::{test}"), "--exact", "--nocapture"]).env(ROLE, "other").env("AFU_CACHE", cache);
    command.envs(variables.iter().copied()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn processes_and_threads_may_build_the_same_at_once() {
    let build = || {
        let model = Model::build(&counter("// at once"), Trace::Off).unwrap();
        assert_eq!(count_to(&model.instance(0).unwrap(), 7), 7);
    };
    if env::var_os(ROLE).is_some() {
        thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(build))));
        return;
    }
    let cache = tempfile::tempdir().unwrap();
    let name = "processes_and_threads_may_build_the_same_at_once";
    // A variable that no compiler reads does not lead to another model.
    let mut others = ["one", "other"].map(|value| in_another_process(name, cache.path(), &[("AFU_TEST_OF", value)]));
    assert!(others.iter_mut().all(|other| other.wait().unwrap().success()));
    let left = || {
        let left = entries(cache.path());
        (left.iter().filter(|folder| folder.join("model.so").is_file()).count(), left.len())
    };
    assert_eq!(left(), (1, 2), "one model and the runtime, no lock and nothing half made");
    assert!(in_another_process(name, cache.path(), &[("CPATH", "/nowhere")]).wait().unwrap().success());
    assert_eq!(left(), (2, 4), "what it reads does");
}

#[test]
fn a_missing_tool_is_named_with_what_installs_it() {
    if env::var_os(ROLE).is_some() {
        let error = Model::build(&counter("// missing"), Trace::Off).unwrap_err();
        assert!(matches!(error, CosimError::MissingTool { .. }), "{error:?}");
        println!("\n{error}");
        return;
    }
    let says = |variable: (&str, &str)| {
        let cache = tempfile::tempdir().unwrap();
        let other = in_another_process("a_missing_tool_is_named_with_what_installs_it", cache.path(), &[variable]);
        let output = other.wait_with_output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{text}");
        assert!(entries(cache.path()).is_empty());
        text.lines().find(|line| line.contains("is missing")).unwrap().to_owned()
    };
    let verilator = says(("AFU_VERILATOR", "/nowhere/verilator_bin"));
    assert!(verilator.starts_with("Verilator is missing (AFU_VERILATOR is `/nowhere/verilator_bin`"), "{verilator}");
    assert!(verilator.contains("install it with: scripts/setup"), "{verilator}");
    let not_one = says(("AFU_VERILATOR", "/bin/true"));
    assert!(not_one.starts_with("Verilator is missing"), "{not_one}");
    let compiler = says(("CXX", "/nowhere/c++"));
    assert!(
        compiler.starts_with("a C++ compiler is missing") && compiler.contains("apt-get install g++"),
        "{compiler}"
    );
}

/// An incomplete model is not accepted from the cache, and a failure leaves no files.
#[test]
fn a_refused_build_leaves_nothing_in_the_cache() {
    let cache = tempfile::tempdir().unwrap();
    let bad = counter("assign nothing = 1'b1 +;");
    assert!(Model::build_in(&bad, Trace::Off, cache.path()).is_err());
    assert_eq!(entries(cache.path()), Vec::<PathBuf>::new());
}
