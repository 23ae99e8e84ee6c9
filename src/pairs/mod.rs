//! Pairs by name (`diamond:10`, `random:1000`, `hard:1000`) and from files, and contacts in files: CSV and `.npy`.

mod array;
mod columns;
mod contacts_csv;
mod cure;
mod dense;
mod diamond;
mod error;
mod file;
mod hard;
mod makers;
mod npy;
mod npy_header;
mod pairs_csv;
mod random;
mod set;
mod source;
mod sphere_plane;
mod table;

pub(crate) use columns::{Columns, Words};
pub(crate) use diamond::octahedron;
pub use error::FileError;
pub use file::{
    LoadError, Loaded, Rounded, check_name, load, load_with_notes, read_contacts, read_hits, read_pairs,
    read_with_notes, write_contacts, write_hits, write_pairs, write_pairs_csv,
};
pub(crate) use file::{read_records, write_records, write_touching};
pub use hard::{CATEGORIES, Category};
pub use makers::categories;
pub use npy::numbers as npy_of_numbers;
pub use set::{Set, SetError};
