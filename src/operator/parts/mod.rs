//! What operators are put together from: operands taken apart, shifters, counters, products, rounding.

mod leading_zeros;
mod normalise;
mod operand;
mod product;
mod round;
mod shift;
mod signed;

pub use leading_zeros::leading_zeros;
pub use normalise::normalise;
pub use operand::Operand;
pub use product::{product, product_low, product_of, square, square_low};
pub use round::{Rounded, Rounding, Special, Unrounded, pack, round, round_so};
pub use shift::{shift_left, shift_right_sticky};
pub use signed::Signed;
