// Implements harness.h for any module that Verilator made into the class `Vmodel`. `ports.inc`, written beside the
// class, lists its ports as AFU_PORT(name, bits, direction, member).

#include "harness.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ios>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "Vmodel.h"
#include "verilated.h"

#if AFU_TRACE == 1
#include "verilated_vcd_c.h"
using Waveform = VerilatedVcdC;
#elif AFU_TRACE == 2
#include "verilated_fst_c.h"
using Waveform = VerilatedFstC;
extern "C" bool afu_fst_failed(); // fst.cpp
#endif

namespace {

std::string where(const char *file, int line, const char *scope) {
    std::string text;
    if (file && *file) text += std::string(file) + ":" + std::to_string(line) + ": ";
    if (scope && *scope) text += std::string("in ") + scope + ": ";
    return text;
}

thread_local std::string creation_error;

// The waveform's writer failed, not the model.
struct waveform_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace

// Verilator's own versions of these end the process. The runtime is compiled with VL_USER_FATAL, VL_USER_STOP and
// VL_USER_FINISH, so that they are defined here. The exception ends the evaluation and is caught before the interface.
void vl_fatal(const char *file, int line, const char *scope, const char *message) {
    throw std::runtime_error(where(file, line, scope) + (message ? message : "fatal error"));
}
void vl_stop(const char *file, int line, const char *scope) {
    throw std::runtime_error(where(file, line, scope) + "$stop, or an $error or assertion that stops");
}
void vl_finish(const char *file, int line, const char *scope) {
    throw std::runtime_error(where(file, line, scope) + "$finish");
}

struct afu_instance {
    std::unique_ptr<VerilatedContext> context;
    std::unique_ptr<Vmodel> model;
    std::vector<afu_port> ports;
    std::string error_text;
    bool failed = false;
#if AFU_TRACE
    std::unique_ptr<Waveform> waveform;
    bool tracing = false;
    uint64_t half_period_ps = 1;
    uint64_t now_ps = 0;

    // Runs `body`, which writes the waveform. A writer that has failed would fail again in its destructor, which must
    // not throw, so it is released and never destroyed.
    template <class Body> void writing(Body body) {
        std::string why;
        errno = 0;
        try {
            body();
#if AFU_TRACE == 2
            if (!afu_fst_failed()) return;
            why = "not everything could be written: the disk may be full";
#else
            return;
#endif
        } catch (const std::ios_base::failure &e) {
            why = errno ? std::strerror(errno) : e.what();
        } catch (const std::exception &e) {
            why = e.what();
        } catch (...) {
            why = "unknown C++ exception";
        }
        tracing = false;
        static_cast<void>(waveform.release());
        throw waveform_error(why);
    }

    void dump() {
        if (!tracing) return;
        writing([&] { waveform->dump(now_ps); });
        now_ps += half_period_ps;
    }
#else
    void dump() {}
#endif

    // Runs `body`, and turns an exception into -1 or AFU_WAVEFORM, with a text. Verilator's runtime finds the context
    // through the thread, for instance for a $stop. It must be this instance's, not that of the last instance that the
    // thread made, which may be destroyed.
    template <class Body> int guarded(Body body) {
        if (Verilated::threadContextp() != context.get()) Verilated::threadContextp(context.get());
        try {
            body();
            return 0;
        } catch (const waveform_error &e) {
            error_text = e.what();
            return AFU_WAVEFORM;
        } catch (const std::exception &e) {
            error_text = e.what();
        } catch (...) {
            error_text = "unknown C++ exception";
        }
        return -1;
    }

    // As `guarded`, for a `body` that runs the model. After an exception, the model can no longer be used.
    template <class Body> int simulated(Body body) {
        if (failed) return -1;
        const int result = guarded(body);
        failed = result != 0;
        return result;
    }
};

namespace {

afu_instance *create(uint64_t seed) {
    try {
        auto instance = std::make_unique<afu_instance>();
        // Also becomes the thread's context, in which parts of the design that are separate libraries are created.
        instance->context = std::make_unique<VerilatedContext>();
        VerilatedContext *context = instance->context.get();
        context->randReset(seed ? 2 : 0);
        if (seed) {
            const int folded = static_cast<int>((seed ^ (seed >> 31)) & 0x7fffffff);
            context->randSeed(folded ? folded : 1); // 0 would let Verilator choose one
        }
        context->traceEverOn(AFU_TRACE != 0);
        instance->model = std::make_unique<Vmodel>(context);
        Vmodel &model = *instance->model;
#define AFU_PORT(name, bits, direction, member) \
    instance->ports.push_back(afu_port{name, bits, direction, static_cast<void *>(&model.member)});
#include "ports.inc"
#undef AFU_PORT
        // Inputs begin as zero even if the rest is random, so that an input that the caller does not drive is not noise.
        for (const afu_port &port : instance->ports) {
            const uint32_t bytes =
                port.bits <= 8 ? 1 : port.bits <= 16 ? 2 : port.bits <= 32 ? 4 : port.bits <= 64 ? 8 : (port.bits + 31) / 32 * 4;
            if (port.direction == AFU_INPUT) std::memset(port.address, 0, bytes);
        }
        model.eval();
        return instance.release();
    } catch (const std::exception &e) {
        creation_error = e.what();
    } catch (...) {
        creation_error = "unknown C++ exception";
    }
    return nullptr;
}

void destroy(afu_instance *instance) {
    if (!instance) return;
#if AFU_TRACE
    instance->guarded([&] {
        if (instance->tracing) instance->writing([&] { instance->waveform->close(); });
    });
#endif
    if (!instance->failed) instance->guarded([&] { instance->model->final(); });
    delete instance;
    Verilated::threadContextp(nullptr);
}

const afu_port *ports(afu_instance *instance, uint32_t *count) {
    *count = static_cast<uint32_t>(instance->ports.size());
    return instance->ports.data();
}

int evaluate(afu_instance *instance) {
    return instance->simulated([&] { instance->model->eval(); });
}

int clock_cycles(afu_instance *instance, uint32_t index, uint64_t cycles) {
    if (index >= instance->ports.size() || instance->ports[index].bits != 1 ||
        instance->ports[index].direction != AFU_INPUT) {
        instance->error_text = "the clock must be a one-bit input";
        return -1;
    }
    CData &clk = *static_cast<CData *>(instance->ports[index].address);
    return instance->simulated([&] {
        Vmodel &model = *instance->model;
        for (uint64_t cycle = 0; cycle < cycles; ++cycle) {
            clk = 1;
            model.eval();
            instance->dump();
            clk = 0;
            model.eval();
            instance->dump();
        }
    });
}

#if AFU_TRACE
int trace_open(afu_instance *instance, const char *path, uint64_t half_period_ps) {
    return instance->guarded([&] {
        if (instance->tracing) throw std::runtime_error("a waveform is already being written");
        if (half_period_ps == 0) throw std::runtime_error("the half period must not be zero");
        // If a file exceeds its size limit, the write fails, as on a full disk, and the process does not end.
        const auto handler = std::signal(SIGXFSZ, SIG_IGN);
        if (handler != SIG_DFL) std::signal(SIGXFSZ, handler);
        instance->writing([&] {
            if (!instance->waveform) {
                instance->waveform = std::make_unique<Waveform>();
                instance->model->trace(instance->waveform.get(), 99);
            }
            instance->waveform->set_time_unit("1ps");
            instance->waveform->set_time_resolution("1ps");
            instance->waveform->open(path);
            if (!instance->waveform->isOpen()) throw std::runtime_error("the file cannot be created");
        });
        instance->tracing = true;
        instance->half_period_ps = half_period_ps;
    });
}

int trace_close(afu_instance *instance) {
    return instance->guarded([&] {
        if (!instance->tracing) throw std::runtime_error("no waveform is being written");
        instance->writing([&] { instance->waveform->close(); });
        instance->tracing = false;
    });
}
#else
int trace_open(afu_instance *instance, const char *, uint64_t) {
    instance->error_text = "this model was built without waveforms";
    return -1;
}

int trace_close(afu_instance *instance) { return trace_open(instance, nullptr, 0); }
#endif

const char *error_text(afu_instance *instance) {
    return instance ? instance->error_text.c_str() : creation_error.c_str();
}

const afu_table table = {AFU_ABI, AFU_TRACE, AFU_RTL_SHA256, create,     destroy,     ports,
                         evaluate, clock_cycles, trace_open,  trace_close, error_text};

} // namespace

const afu_table *afu_model(void) { return &table; }
