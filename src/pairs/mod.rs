//! Pairs by name (`diamond:10`, `random:1000`, `hard:1000`) and from files, and contacts to files: CSV and `.npy`.

mod contacts_csv;
mod dense;
mod diamond;
mod error;
mod file;
mod hard;
mod npy;
mod npy_header;
mod pairs_csv;
mod random;
mod set;
mod source;
mod table;

pub use diamond::octahedron;
pub use error::FileError;
pub use file::{
    LoadError, check_name, load, read_contacts, read_hits, read_pairs, write_contacts, write_hits, write_pairs,
};
pub use hard::{CATEGORIES, Category};
pub use npy::numbers as npy_of_numbers;
pub use set::{Set, SetError};
