// SPDX-License-Identifier: MIT OR Apache-2.0
// How many of a row's 16 bits are set.
  function [4:0] ones(input [15:0] bits);
    integer place;
    begin
      ones = 0;
      for (place = 0; place < 16; place = place + 1) ones = ones + {4'd0, bits[place]};
    end
  endfunction
