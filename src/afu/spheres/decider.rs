//! A decider: the kernel that says whether two spheres touch, with the spheres of its columns. It gets the candidates
//! of a step, decides one per cycle, and answers with those that touch.

use std::sync::Arc;

use super::bits::{number, place_of};
use super::bounds::SPHERE_BITS;
use super::store::{CYCLES_TO_WORD, Store};
use super::walk::{Item, walk};
use super::{SLACK, Sizes};
use crate::afu::Spec;
use crate::afu::counter::later;
use crate::afu::queue::{queue, steering_queue};
use crate::hdl::{BuildErrors, Graph, Module, Signal};
use crate::query::Query;

/// Builds the module `contact_afu_decider` around a kernel of `--contact hit`.
///
/// A share is a bit for each pair of a sphere that was compared with a column of this decider. The answer to a
/// share that is not zero comes in the order of the shares.
pub(super) fn decider(spec: &Spec, sizes: &Sizes, kernel: &Arc<Module>) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("contact_afu_decider");
    graph.about("decides which candidates touch: those with the columns of this decider");
    let (share_bits, column_bits, places_bits) = (sizes.share(), sizes.column_bits(), sizes.places_bits());
    let start = graph.input("start", 1);
    let kept_bits = sizes.kept_bits;
    let put = graph.input("put", 1);
    let share = graph.input("share", share_bits);
    let kept = graph.input("kept", kept_bits);
    let row = graph.input("row", sizes.row_bits);
    let places = (places_bits > 0).then(|| graph.input("places", places_bits));
    let about: Vec<_> = [kept].into_iter().chain(places).chain([row]).collect();
    let about = Signal::join(&about);
    let about_bits = about.width();

    // Shares wait here. There are never more than steps that are not joined yet. A share's bits decide when it leaves.
    let always = graph.constant(1, 1);
    let shares = steering_queue(sizes.undecided, (share_bits + about_bits, share_bits), SLACK)?;
    let takes = graph.wire("takes", 1);
    let inputs = [("start", start), ("put", put), ("word", about.concat(share)), ("take", takes)];
    let waiting = graph.instance("shares", &shares, &inputs);
    let oldest = waiting.output("oldest");
    let item =
        Item { valid: waiting.output("valid"), mask: oldest.low(share_bits), about: oldest.drop_low(share_bits) };
    let walk = walk(&graph, start, &item, always);
    takes.drive(walk.takes);

    // The spheres of the candidate.
    let bit = number(walk.bit).named("candidate");
    let own_row = walk.about.low(sizes.row_bits);
    let other = if column_bits > 0 { own_row.concat(bit.low(column_bits)) } else { own_row };
    let places = (places_bits > 0).then(|| walk.about.slice(sizes.row_bits, places_bits));
    let sphere = if sizes.compared > 1 { bit.drop_low(column_bits) } else { bit };
    let place = place_of("place", places, sphere);
    let spheres = sizes.of_loaded("write_sphere");
    let spheres: Vec<_> = spheres.iter().map(|name| graph.input(name, SPHERE_BITS)).collect();
    let of_columns = graph.input("write_sphere_of_column", SPHERE_BITS);
    let column = graph.input("write_column", sizes.loaded_bits());
    let [write_table, write_kept] = ["write_table", "write_kept"].map(|name| graph.input(name, 1));
    let write_row = graph.input("write_row", sizes.row_bits);
    let write_place = if column_bits > 0 { write_row.concat(column.high(column_bits)) } else { write_row };
    let table = Store::new(spec, sizes.decider_bits());
    let first =
        table.column(&graph, "columns", [write_table, write_place, of_columns], other.named("place_in_table"))?;
    let write_own = graph.input("write_kept_row", kept_bits).concat(column);
    let rows = Store::new(spec, kept_bits + sizes.loaded_bits());
    let own = (walk.about.high(kept_bits).named("row_in_hand"), place.named("place_in_row"));
    let second = rows.sides(&graph, "rows", (write_kept, write_own), &spheres, own)?;

    // The pair of both, and the decision.
    let word_bits = SPHERE_BITS / 4;
    let words: Vec<_> = (0..8)
        .map(|word| {
            let sphere = if word < 4 { first } else { second };
            sphere.slice(word % 4 * word_bits, word_bits)
        })
        .collect();
    let names = Query::SphereSphere.shape().inputs.iter().map(|input| input.name);
    let inputs: Vec<_> = names.zip(words).chain([("valid", always)]).collect();
    let hit = graph.instance("kernel", kernel, &inputs).output("hit");

    // The candidate's bit comes back beside the decision.
    let latency = CYCLES_TO_WORD + kernel.latency;
    let decided = later(start, walk.steps, latency, "decided");
    let bit_then = walk.bit.delay(latency).named("candidate_then");
    let is_last = walk.is_last.delay(latency).named("is_last_then");
    let hits = graph.data_register("hits_so_far", share_bits);
    let now = (*hits | bit_then.gate(hit)).named("hits_now");
    let fresh = graph.register("is_fresh", 1, 1);
    let ends = (decided & is_last).named("share_ends");
    let hits_now = fresh.select(bit_then.gate(hit), now).named("answer_now");
    hits.next_if(decided, hits_now);
    fresh.next(start | decided.select(is_last, *fresh));
    let answers = queue(sizes.undecided, share_bits, SLACK)?;
    let inputs = [
        ("start", start),
        ("put", (ends & !start).registered("answer_comes")),
        ("word", hits_now.delay(1).named("answer_put")),
        ("take", graph.input("take_answer", 1)),
    ];
    let answers = graph.instance("answers", &answers, &inputs);
    graph.output("answer_valid", answers.output("valid"));
    graph.output("answer", answers.output("oldest"));
    graph.finish()
}
