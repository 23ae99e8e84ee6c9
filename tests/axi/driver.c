/* A driver in C, which knows only contact_afu_regs.h, on a Verilated shell: over AXI4-Lite it reads the identity and
 * starts a job without pairs.
 */
#include <dlfcn.h>
#include <stdio.h>
#include <stdint.h>
#include <string.h>

#include "contact_afu_regs.h"
#include "harness.h"

static const afu_table *table;
static afu_instance *afu;
static uint32_t clock_index;

static void fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    _Exit(1);
}

/* The address of a port's value. */
static void *port(const char *name) {
    uint32_t count;
    const afu_port *ports = table->ports(afu, &count);
    for (uint32_t index = 0; index < count; index++)
        if (strcmp(ports[index].name, name) == 0) return ports[index].address;
    fail(name);
    return NULL;
}

static uint8_t *bit(const char *name) { return port(name); }

static void tick(void) {
    if (table->clock(afu, clock_index, 1) != 0) fail(table->error(afu));
}

static void write_register(uint32_t offset, uint32_t value) {
    *(uint16_t *)port("s_axi_control_awaddr") = (uint16_t)offset;
    *(uint32_t *)port("s_axi_control_wdata") = value;
    *bit("s_axi_control_wstrb") = 0xf;
    *bit("s_axi_control_awvalid") = *bit("s_axi_control_wvalid") = *bit("s_axi_control_bready") = 1;
    /* One access at a time: both are ready. */
    if (!*bit("s_axi_control_awready") || !*bit("s_axi_control_wready")) fail("a write is refused");
    tick();
    *bit("s_axi_control_awvalid") = *bit("s_axi_control_wvalid") = 0;
    for (int cycle = 0; !*bit("s_axi_control_bvalid"); cycle++) {
        if (cycle > 100) fail("a write has no response");
        tick();
    }
    tick();
}

static uint32_t read_register(uint32_t offset) {
    *(uint16_t *)port("s_axi_control_araddr") = (uint16_t)offset;
    *bit("s_axi_control_arvalid") = *bit("s_axi_control_rready") = 1;
    if (!*bit("s_axi_control_arready")) fail("a read is refused");
    tick();
    *bit("s_axi_control_arvalid") = 0;
    for (int cycle = 0; !*bit("s_axi_control_rvalid"); cycle++) {
        if (cycle > 100) fail("a read has no data");
        tick();
    }
    uint32_t value = *(uint32_t *)port("s_axi_control_rdata");
    tick();
    return value;
}

int main(int arguments, char **argument) {
    if (arguments != 2) fail("give the model's library");
    void *library = dlopen(argument[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) fail(dlerror());
    const afu_table *(*model)(void);
    *(void **)&model = dlsym(library, "afu_model");
    if (model == NULL) fail("no model in the library");
    table = model();
    afu = table->create(1);
    uint32_t count;
    const afu_port *ports = table->ports(afu, &count);
    for (uint32_t index = 0; index < count; index++)
        if (strcmp(ports[index].name, "ap_clk") == 0) clock_index = index;
    for (int cycle = 0; cycle < 16; cycle++) tick();
    *bit("ap_rst_n") = 1;
    for (int cycle = 0; cycle < 4; cycle++) tick();

    const uint32_t identity[4] = {CONTACT_AFU_AFU_ID_0, CONTACT_AFU_AFU_ID_1, CONTACT_AFU_AFU_ID_2,
                                  CONTACT_AFU_AFU_ID_3};
    for (uint32_t word = 0; word < 4; word++)
        if (read_register(CONTACT_AFU_AFU_ID + 4 * word) != identity[word]) fail("another accelerator");
    if (read_register(CONTACT_AFU_VERSION) != CONTACT_AFU_VERSION_OF_MAP) fail("another version of the map");
    write_register(CONTACT_AFU_SCRATCH, 0x12345678u);
    if (read_register(CONTACT_AFU_SCRATCH) != 0x12345678u) fail("the scratch register does not keep its value");
    if (!(read_register(CONTACT_AFU_CONTROL) & CONTACT_AFU_CONTROL_AP_IDLE)) fail("not idle");

    /* A job without pairs, and one with a mode that does not exist. */
    for (uint32_t mode = 0; mode < 2; mode++) {
        uint32_t error = mode == 0 ? 0 : CONTACT_AFU_ERROR_MODE;
        uint32_t status = 0;
        write_register(CONTACT_AFU_COUNT, 0);
        write_register(CONTACT_AFU_MODE, mode);
        write_register(CONTACT_AFU_CONTROL, CONTACT_AFU_CONTROL_AP_START);
        for (int reads = 0; !(status & CONTACT_AFU_STATUS_DONE); reads++) {
            if (reads > 1000) fail("the job does not end");
            status = read_register(CONTACT_AFU_STATUS);
        }
        if ((status & CONTACT_AFU_STATUS_ERROR) >> CONTACT_AFU_STATUS_ERROR_SHIFT != error) fail("another error");
    }
    puts("done");
    return 0;
}
