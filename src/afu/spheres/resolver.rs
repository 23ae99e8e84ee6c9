//! The resolver of an AFU that takes spheres: all spheres that are in the table or searched, in front of the SCPUs that
//! compute the contacts of those that touch.

use std::sync::Arc;

use super::bounds::SPHERE_BITS;
use super::store::Store;
use super::{NUMBER_BITS, ROW_BITS, Sizes};
use crate::afu::Spec;
use crate::afu::resolver::resolve;
use crate::hdl::{BuildErrors, Graph, Module};

/// Builds the module `contact_afu_resolver`. The numbers of a hit come a cycle after `carries`, which is `from_step`
/// cycles after its step in the stage before.
pub(super) fn resolver(
    spec: &Spec,
    sizes: &Sizes,
    scpu: &Arc<Module>,
    from_step: u32,
) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_resolver");
    graph.about("computes the contacts of the spheres that touch");
    let start = graph.input("start", 1);
    let carries = graph.input("carries", 1);
    let numbers = graph.input("numbers", 2 * NUMBER_BITS);

    // The two spheres: the first is in the table, the second in a row that is searched.
    let names = sizes.of_loaded("write_sphere");
    let spheres: Vec<_> = names.iter().map(|name| graph.input(name, SPHERE_BITS)).collect();
    let column = graph.input("write_column", sizes.loaded_bits());
    let mut both = Vec::new();
    for (name, number, row_bits) in
        [("table", numbers.low(NUMBER_BITS), sizes.row_bits), ("kept", numbers.high(NUMBER_BITS), sizes.kept_bits)]
    {
        let write = graph.input(&format!("write_{name}"), 1);
        let write_place = graph.input(&format!("write_{name}_row"), row_bits).concat(column);
        let row = number.slice(ROW_BITS, row_bits).named(&format!("row_in_{name}"));
        let place = number.low(ROW_BITS).named(&format!("column_in_{name}"));
        let store = Store::new(spec, row_bits + sizes.loaded_bits());
        both.push(store.sides(&graph, &format!("{name}_spheres"), (write, write_place), &spheres, (row, place))?);
    }
    let pair = both[1].concat(both[0]).named("pair");
    resolve(&graph, spec, scpu, [start, carries, numbers, pair], from_step)?;
    graph.finish()
}
