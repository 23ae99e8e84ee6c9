// The reference loop for benches/step.rs: the job and the ideal link as one would write them by hand in C++ around the
// same model, without any check. It finds the model through the library that the Rust side has loaded.

#include <dlfcn.h>
#include <time.h>

#include <cstdint>
#include <cstring>

#include "../tb/harness.h"

namespace {

struct Ports {
    const afu_port *first;
    uint32_t count;

    const afu_port *find(const char *name) const {
        for (uint32_t i = 0; i < count; ++i) {
            if (!std::strcmp(first[i].name, name)) return &first[i];
        }
        return nullptr;
    }
    template <class T> T &at(const char *name) const { return *static_cast<T *>(find(name)->address); }
};

} // namespace

// CPU seconds of this thread, so that other programs do not affect the result.
extern "C" double cpu_seconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

// Opens the model in `library`; returns its table, or null.
extern "C" const afu_table *open_model(const char *library) {
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    auto model = handle ? reinterpret_cast<const afu_table *(*)()>(dlsym(handle, "afu_model")) : nullptr;
    return model ? model() : nullptr;
}

// Runs `pairs` pairs from the lines at `source` into `destination` on a new instance, `idle` cycles after its reset,
// over a link that answers in the next cycle. Returns the number of cycles from start to done, or 0 on an error or after
// `limit` cycles. Stores their CPU time in `seconds`.
extern "C" uint64_t run_job(const afu_table *table, const uint32_t *source, uint32_t *destination, uint32_t pairs,
                            uint64_t idle, uint64_t limit, double *seconds) {
    afu_instance *afu = table->create(0);
    if (!afu) return 0;
    Ports ports;
    ports.first = table->ports(afu, &ports.count);
    const uint32_t clk = static_cast<uint32_t>(ports.find("clk") - ports.first);

    uint8_t &rd_req_valid = ports.at<uint8_t>("rd_req_valid"), &rd_rsp_valid = ports.at<uint8_t>("rd_rsp_valid");
    uint64_t &rd_req_address = ports.at<uint64_t>("rd_req_address");
    uint16_t &rd_req_tag = ports.at<uint16_t>("rd_req_tag"), &rd_rsp_tag = ports.at<uint16_t>("rd_rsp_tag");
    uint32_t *rd_rsp_data = &ports.at<uint32_t>("rd_rsp_data");
    uint8_t &wr_req_valid = ports.at<uint8_t>("wr_req_valid"), &wr_rsp_valid = ports.at<uint8_t>("wr_rsp_valid");
    uint64_t &wr_req_address = ports.at<uint64_t>("wr_req_address");
    uint16_t &wr_req_tag = ports.at<uint16_t>("wr_req_tag"), &wr_rsp_tag = ports.at<uint16_t>("wr_rsp_tag");
    const uint32_t *wr_req_data = &ports.at<uint32_t>("wr_req_data");
    const uint8_t &done = ports.at<uint8_t>("done");
    const uint64_t destination_address = 1ull << 40;

    ports.at<uint8_t>("rst") = 1;
    table->clock(afu, clk, 4);
    ports.at<uint8_t>("rst") = 0;
    table->clock(afu, clk, idle);
    ports.at<uint8_t>("rd_req_ready") = 1;
    ports.at<uint8_t>("wr_req_ready") = 1;
    const double begun = cpu_seconds();
    ports.at<uint64_t>("source") = 0;
    ports.at<uint64_t>("destination") = destination_address;
    ports.at<uint32_t>("count") = pairs;
    ports.at<uint8_t>("epoch") = 1;
    uint8_t &start = ports.at<uint8_t>("start");
    start = 1;
    uint64_t cycles = 0;
    bool read = false, write = false;
    uint64_t address = 0;
    uint16_t read_tag = 0, write_tag = 0;
    while (!done && cycles < limit) {
        rd_rsp_valid = read;
        if (read) {
            rd_rsp_tag = read_tag;
            std::memcpy(rd_rsp_data, source + 16 * address, 64);
        }
        wr_rsp_valid = write;
        wr_rsp_tag = write_tag;
        read = rd_req_valid;
        address = rd_req_address;
        read_tag = rd_req_tag;
        write = wr_req_valid;
        if (write) {
            write_tag = wr_req_tag;
            std::memcpy(destination + 16 * (wr_req_address - destination_address), wr_req_data, 64);
        }
        if (table->clock(afu, clk, 1) != 0) break;
        start = 0;
        ++cycles;
    }
    *seconds = cpu_seconds() - begun;
    const bool finished = done;
    table->destroy(afu);
    return finished ? cycles : 0;
}
