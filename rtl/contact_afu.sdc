# The clock that the stages were cut for.
create_clock -name clk -period 5.000 [get_ports clk]
