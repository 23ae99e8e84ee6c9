//! Requests: from the core and the shell into SPL's two transmit ports, each with a number that identifies its
//! response.
//!
//! A request stands in the port's register for one cycle, in which SPL takes it. No request is put there while SPL's
//! queue is almost full. Numbers and epoch are not reset by SPL's reset but continue, so that responses from before a
//! reset are recognised.

use std::sync::Arc;

use crate::hdl::{BuildErrors, Graph, Module, Register, Signal};

use super::words::{self, NUMBER_BITS, Request, SHELL_EPOCH_BITS, TX_HEADER_BITS};
use crate::afu::{ADDRESS_BITS, EPOCH_BITS, Spec, wide};

/// Builds the module `spl2_transmit`.
pub(super) fn transmit(spec: &Spec) -> Result<Arc<Module>, BuildErrors> {
    let graph = Graph::new("spl2_transmit");
    graph.about("puts requests of core and shell into the transmit ports, and numbers them");
    let slot_bits = spec.max_outstanding.ilog2();
    let power_on = graph.input("power_on", 1);
    let start = graph.input("start", 1);
    let rd_almostfull = graph.input("rd_almostfull", 1);
    let wr_almostfull = graph.input("wr_almostfull", 1);
    // After the core has given up, its remaining requests are taken and dropped: SPL may never have room again.
    let discard = graph.input("discard", 1).delay(1).named("discards");

    // The next job's epoch is known before its start, which only selects it.
    let epoch = graph.data_register("epoch", SHELL_EPOCH_BITS);
    let next_epoch = graph.data_register("next_epoch", SHELL_EPOCH_BITS);
    next_epoch.next_if(start | power_on, power_on.select(next_epoch.same(1), next_epoch.plus(1)));
    let known_epoch = start.select(*next_epoch, *epoch).gate(!power_on).named("known_epoch");
    epoch.next(known_epoch);
    // Responses are compared with copies beside them.
    let epochs = known_epoch.data_copies("epoch", 2);

    // Reads. The shell's few reads come first.
    let core_read = graph.input("core_rd_valid", 1);
    let core_read_address = graph.input("core_rd_address", ADDRESS_BITS);
    let core_read_tag = graph.input("core_rd_tag", EPOCH_BITS + slot_bits);
    let own_read = graph.input("own_rd_valid", 1);
    let own_read_address = graph.input("own_rd_address", ADDRESS_BITS);
    let reads = Turns::new(&graph, "rd", rd_almostfull);
    let own_read_granted = (own_read & reads.own).named("grants_own_rd");
    let told_of_read = own_read_granted.delay(1).named("own_rd_granted");
    reads.connect(own_read, discard);
    let core_read_ready = reads.core;
    let read_number = number(&graph, "read_number", told_of_read, power_on);
    let granted_number = read_number.delay(1).named("granted_number");
    let constant = |width: u32, value: u128| graph.constant(width, value);
    let read_header = words::header(
        &graph,
        words::kind(&graph, Request::Read),
        constant(1, 1),
        own_read_granted.select(own_read_address, core_read_address),
        own_read_granted.select(
            words::own_mdata(&graph, read_number),
            words::core_mdata(epoch.value(), core_read_tag.low(slot_bits)),
        ),
    );
    let read_valid = graph.data_register("tx_rd_valid", 1);
    let reading = (own_read_granted | (core_read_ready & core_read & !discard)).named("reading");
    read_valid.next(reading & !power_on);
    let read_register = graph.data_register("tx_rd_hdr", TX_HEADER_BITS);
    read_register.next(read_header);

    // Writes: DSM lines that answer registers, then those at the end of a job, then the core's.
    let core_write = graph.input("core_wr_valid", 1);
    let core_write_address = graph.input("core_wr_address", ADDRESS_BITS);
    let core_write_tag = graph.input("core_wr_tag", EPOCH_BITS + slot_bits);
    let core_write_data = graph.input("core_wr_data", spec.line_bits);
    let register_write = graph.input("register_wr_valid", 1);
    let register_chosen = graph.input("register_wr_chosen", 1);
    let register_write_address = graph.input("register_wr_address", ADDRESS_BITS);
    let register_write_data = graph.input("register_wr_data", spec.line_bits);
    let end_write = graph.input("end_wr_valid", 1);
    let end_write_fence = graph.input("end_wr_fence", 1);
    let end_write_virtual = graph.input("end_wr_virtual", 1);
    let end_write_address = graph.input("end_wr_address", ADDRESS_BITS);
    let end_write_data = graph.input("end_wr_data", spec.line_bits);
    // A write of the shell is chosen one cycle before its turn.
    let writes = Turns::new(&graph, "wr", wr_almostfull);
    let is_register = register_write.delay(1).named("is_register");
    let register_granted = (writes.own & is_register & register_write).named("grants_register_wr");
    let end_granted = (writes.own & !is_register & end_write).named("grants_end_wr");
    let own_granted = (register_granted | end_granted).named("own_granted");
    let told_of_register = register_granted.delay(1).named("register_wr_granted");
    let told_of_end = end_granted.delay(1).named("end_wr_granted");
    let turn_is_own = writes.connect(register_write | end_write, discard);
    let chooses_own = wide::steering(turn_is_own, "chooses_own_wr", TX_HEADER_BITS + spec.line_bits);
    let write_number = number(&graph, "write_number", told_of_register | told_of_end, power_on);
    let is_fence = (end_write_fence & !register_write).named("is_fence");
    let write_line = words::kind(&graph, Request::WriteLine);
    let own_address = register_chosen.select(register_write_address, end_write_address).named("own_wr_address");
    let own_header = words::header(
        &graph,
        is_fence.select(words::kind(&graph, Request::WriteFence), write_line),
        register_chosen.select(constant(1, 0), end_write_virtual),
        own_address,
        words::own_mdata(&graph, write_number),
    );
    let own_header = own_header.delay(1).named("own_header");
    let own_data = register_chosen.select(register_write_data, end_write_data).delay(1).named("own_data");

    let core_write_ready = writes.core;
    let core_mdata = words::core_mdata(epoch.value(), core_write_tag.low(slot_bits));
    let core_header = words::header(&graph, write_line, constant(1, 1), core_write_address, core_mdata);
    let write_valid = graph.data_register("tx_wr_valid", 1);
    let writing = (own_granted | (core_write_ready & core_write & !discard)).named("writing");
    write_valid.next(writing & !power_on);
    let (own_request, core_request) = (own_header.concat(own_data), core_header.concat(core_write_data));
    let request = wide::select(&chooses_own, own_request, core_request);
    let write_register = graph.data_register("tx_wr_hdr", TX_HEADER_BITS);
    write_register.next(request.high(TX_HEADER_BITS));
    let data_register = graph.data_register("tx_data", spec.line_bits);
    data_register.next(request.low(spec.line_bits));

    graph.output("read_epoch", epochs[0]);
    graph.output("write_epoch", epochs[1]);
    graph.output("core_epoch", next_epoch.low(EPOCH_BITS));
    graph.output("read_number", granted_number);
    graph.output("own_rd_granted", told_of_read);
    graph.output("core_rd_ready", core_read_ready);
    graph.output("register_wr_granted", told_of_register);
    graph.output("end_wr_granted", told_of_end);
    graph.output("core_wr_ready", core_write_ready);
    graph.output("tx_rd_valid", read_valid.value());
    graph.output("tx_rd_hdr", read_register.value());
    graph.output("tx_wr_valid", write_valid.value());
    graph.output("tx_wr_hdr", write_register.value());
    graph.output("tx_data", data_register.value());
    graph.finish()
}

/// The turn of a port, known one cycle ahead: the shell's if it has a request, otherwise the core's. SPL accepts four
/// more requests after almost-full, and at most two arrive.
///
/// The shell is told of a grant one cycle later, and then withdraws its request. So two cycles after each of its turns
/// are not its own, whether or not the request was granted. No turn depends on a grant.
#[derive(Clone, Copy)]
struct Turns<'g> {
    turn: Signal<'g>,
    next_turn: Signal<'g>,
    had: Signal<'g>,
    open: Register<'g>,
    almost_full: Signal<'g>,
    /// The shell's turn.
    own: Signal<'g>,
    /// The core's turn.
    core: Signal<'g>,
}

impl<'g> Turns<'g> {
    fn new(graph: &'g Graph, port: &str, almost_full: Signal<'g>) -> Self {
        let next_turn = graph.wire(&format!("own_{port}_turn_is_next"), 1);
        let turn = next_turn.data_copies(&format!("own_{port}_turn"), 1)[0];
        let had = turn.delay(1).named(&format!("own_{port}_had_turn"));
        let open = graph.data_register(&format!("core_{port}_turn"), 1);
        let room = (!almost_full).delay(1).named(&format!("{port}_room"));
        let own = (turn & room).named(&format!("own_{port}_goes"));
        Self { turn, next_turn, had, open, almost_full, own, core: *open }
    }

    /// The next turn is the shell's, as is returned, if it has a request that `waits`. While the core's requests are
    /// discarded, it gets its turn without room.
    fn connect(self, waits: Signal<'g>, discard: Signal<'g>) -> Signal<'g> {
        self.next_turn.drive(waits & !self.turn & !self.had);
        self.open.next(discard | (!self.next_turn & !self.almost_full));
        self.next_turn
    }
}

/// The number of the shell's next request: the number of requests granted since the system's reset. It is counted when
/// the shell is told, before the next turn.
fn number<'g>(graph: &'g Graph, name: &str, granted: Signal<'g>, power_on: Signal<'g>) -> Signal<'g> {
    let number = graph.data_register(name, NUMBER_BITS);
    number.next_if(granted | power_on, number.plus(1).gate(!power_on));
    number.value()
}
