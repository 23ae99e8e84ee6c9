// SPDX-License-Identifier: MIT OR Apache-2.0
// Sets of the four slots, one bit per slot, for the proofs of the two parts that use slots in turn.

// The set of `many` consecutive slots from `first` on.
function [3:0] slots(input [1:0] first, input [2:0] many);
  reg [7:0] from_zero;
  reg [7:0] from_first;
  begin
    from_zero = (8'd1 << many) - 8'd1;
    from_first = from_zero << first;
    slots = from_first[3:0] | from_first[7:4];
  end
endfunction

// Turns marks by age, the oldest first, into slots; the oldest slot is `first`.
function [3:0] aged(input [3:0] ages, input [1:0] first);
  reg [7:0] from_first;
  begin
    from_first = {4'd0, ages} << first;
    aged = from_first[3:0] | from_first[7:4];
  end
endfunction

// The number of slots in a set.
function [2:0] ones(input [3:0] set);
  ones = {2'd0, set[0]} + {2'd0, set[1]} + {2'd0, set[2]} + {2'd0, set[3]};
endfunction
