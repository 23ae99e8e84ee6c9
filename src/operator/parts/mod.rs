//! Parts of operators: unpacking of operands, shifters, counters, products, rounding.

mod leading_zeros;
mod normalise;
mod operand;
mod product;
mod round;
mod shift;
mod signed;
mod special;

pub use leading_zeros::leading_zeros;
pub use normalise::normalise;
pub use operand::Operand;
pub use product::{product, product_low, product_of, settled_bits, square, square_low, with_product};
pub use round::{Fields, Rounding, Unrounded, round};
pub use shift::{capped, distance_bits, shift_left, shift_right_sticky};
pub use signed::Signed;
pub use special::{Special, pack, result};
