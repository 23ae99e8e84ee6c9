//! Simulates a pipeline in Icarus: one vector per cycle. Outputs are text, including unknown bits.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use contact_afu::hdl::Module;

use crate::synthesise::Files;

/// Numbers and their widths, the most significant first.
pub type Vector = Vec<(u128, u32)>;

/// The vector in binary.
pub fn bits(vector: &Vector) -> String {
    vector.iter().map(|&(value, width)| format!("{value:0width$b}", width = width as usize)).collect()
}

/// The outputs for `inputs`, each `latency` cycles after its input, with the ports in their order.
pub fn simulate(module: &Module, verilog: &Files, latency: u32, inputs: &[Vector]) -> Vec<String> {
    assert!(latency > 0, "a pipeline");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text: Vec<String> = inputs.iter().map(bits).collect();
    fs::write(folder.path().join("in.txt"), text.join("\n") + "\n").expect("written");
    fs::write(folder.path().join("bench.v"), bench(module, latency, inputs.len())).expect("written");

    let mut compile = Command::new("iverilog");
    compile.args([verilog.language, "-s", "bench", "-o", "bench", "bench.v"]).current_dir(folder.path());
    let compiled = compile.args(&verilog.files).output().expect("needs Icarus: run scripts/setup --test");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let ran = Command::new("vvp").current_dir(folder.path()).args(["-n", "bench"]).output().expect("it runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let out = fs::read_to_string(folder.path().join("out.txt")).expect("its outputs");
    out.lines().map(str::to_owned).collect()
}

fn bench(module: &Module, latency: u32, count: usize) -> String {
    let width =
        |output: bool| module.ports.iter().filter(|port| port.output == output).map(|port| port.width).sum::<u32>();
    let mut ports = String::from(".clk(clk)");
    if module.has_reset_port() {
        ports += ", .rst(rst)";
    }
    let mut left = [width(false), width(true)];
    for port in &module.ports {
        let left = &mut left[usize::from(port.output)];
        *left -= port.width;
        let word = if port.output { "out" } else { "in" };
        let _ = write!(ports, ", .{}({word}[{}:{left}])", port.name, *left + port.width - 1);
    }
    format!(
        "`timescale 1ns / 1ps
module bench;
  reg clk = 0;
  always #5 clk = ~clk;
  reg rst = 1;
  reg [{input}:0] vectors [0:{last}];
  reg [{input}:0] in;
  wire [{output}:0] out;
  {name} unit ({ports});
  integer i, file;
  initial begin
    $readmemb(\"in.txt\", vectors);
    file = $fopen(\"out.txt\", \"w\");
    repeat (4) @(negedge clk);
    rst = 0;
    for (i = 0; i < {count} + {latency} - 1; i = i + 1) begin
      // Behind the last vector comes what is unknown.
      in = i < {count} ? vectors[i] : {{{bits}{{1'bx}}}};
      @(negedge clk);
      if (i + 1 >= {latency}) $fwrite(file, \"%b\\n\", out);
    end
    $fclose(file);
    $finish;
  end
endmodule
",
        input = width(false) - 1,
        output = width(true) - 1,
        bits = width(false),
        last = count - 1,
        name = module.name,
    )
}
