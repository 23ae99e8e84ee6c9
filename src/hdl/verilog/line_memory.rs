//! The file of a memory of any size. Widths are values of parameters here, which a graph of nodes does not have.

use super::Memories;
use super::sections::block_style;

/// A gated block memory: what `hdl::block_memory` describes, with its size as parameters.
pub(super) fn line_memory(name: &str, memories: Memories) -> String {
    format!(
        "module {name} #(
  parameter [31:0] DEPTH = 32'd64, // words, at least 2
  parameter [31:0] WIDTH = 32'd512 // bits of a word
) (
  input  wire                     clk,
  input  wire                     write,
  input  wire [$clog2(DEPTH)-1:0] write_index,
  input  wire [WIDTH-1:0]         write_word,
  input  wire                     read,
  input  wire [$clog2(DEPTH)-1:0] read_index,
  input  wire                     advance,
  output reg  [WIDTH-1:0]         word
);

  // ---- memories ----
{style}  reg [WIDTH-1:0] words [0:DEPTH-1];

  // ---- state ----
  reg [WIDTH-1:0] word_read;

  // ---- at the clock edge ----
  always @(posedge clk) begin
    if (read) word_read <= words[read_index];
    if (advance) word <= word_read;
    if (write) words[write_index] <= write_word;
  end

endmodule

`default_nettype wire
",
        style = block_style(memories)
    )
}

#[cfg(test)]
mod tests {
    use crate::hdl::verilog::{Style, emit};
    use crate::hdl::{Graph, Ports, block_memory};

    /// Memories of different sizes have the same file, and each instance its size.
    #[test]
    fn one_file_serves_every_size() {
        let graph = Graph::new("both");
        let clear = graph.input("clear", 1);
        let texts = [(4_u32, 8_u32), (256, 512)].map(|(depth, width)| {
            let memory = block_memory(depth, width, Ports::Gated, None).unwrap();
            let index = graph.constant(depth.ilog2(), 0);
            let word = graph.constant(width, 0);
            let inputs = [("write", clear), ("write_index", index), ("write_word", word)];
            let inputs = inputs.into_iter().chain([("read_index", index), ("read", clear), ("advance", clear)]);
            let name = format!("of_{depth}");
            let inputs: Vec<_> = inputs.collect();
            graph.output(&format!("word_{depth}"), graph.instance(&name, &memory, &inputs).output("word"));
            emit(&memory, &Style::default())
        });
        assert_eq!(texts[0], texts[1]);
        let both = emit(&graph.finish().unwrap(), &Style::default());
        assert!(both.contains("line_memory #(\n    .DEPTH (32'd4),\n    .WIDTH (32'd8)\n  ) of_4 ("), "{both}");
        assert!(both.contains("line_memory #(\n    .DEPTH (32'd256),\n    .WIDTH (32'd512)\n  ) of_256 ("), "{both}");
    }
}
