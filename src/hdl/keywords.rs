//! Words that Verilog-2005 and SystemVerilog keep for themselves and a generator might stumble over.

pub(super) fn keywords() -> impl Iterator<Item = &'static str> {
    KEYWORDS.split_whitespace()
}

const KEYWORDS: &str = "
    always and assign automatic begin bit buf byte case cell class clocking config const constraint context
    cover deassign default defparam design disable do edge else end endcase endgenerate endmodule enum event
    expect export extends extern final first_match for force foreach forever fork function generate genvar
    global if iff import include initial inout input inside instance int integer interface join large liblist
    library local localparam logic longint macromodule matches medium modport module nand negedge new nor not
    null or output package packed parameter posedge primitive priority program property protected pull0 pull1
    pure rand randc real ref reg release repeat return scalared sequence shortint shortreal signed small solve
    specify static string strong struct super supply0 supply1 table tagged task this throughout time
    timeprecision timeunit tran tri type typedef union unique unsigned until use var vectored virtual void wait
    wand weak while wildcard wire with within wor xnor xor
";
