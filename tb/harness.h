/* The C ABI over any Verilated module: one exported function, which returns a table.
 *
 * A port is memory: its address is fetched once per instance and then read and written directly. Scalars of up to 8,
 * 16, 32 and 64 bits are one unsigned integer of that size. Wider ports are 32-bit words, least significant first.
 * Bits above a port's width are zero and must stay zero.
 *
 * No C++ exception crosses this interface. A function that returns int returns 0 on success, and otherwise -1, with a
 * text from `error`. After an error of `evaluate` or `clock` ($fatal, $stop, $finish, a Verilator check), the instance
 * only repeats that error. If the waveform could not be written, the function returns AFU_WAVEFORM instead of -1, and
 * the waveform is abandoned. Each instance has its own VerilatedContext, so different threads may run different
 * instances.
 */
#ifndef AFU_HARNESS_H
#define AFU_HARNESS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Changes with every change of this file that affects callers. */
#define AFU_ABI 2u

#define AFU_INPUT 0u
#define AFU_OUTPUT 1u

#define AFU_TRACE_OFF 0u
#define AFU_TRACE_VCD 1u
#define AFU_TRACE_FST 2u

#define AFU_WAVEFORM (-2)

typedef struct afu_port {
    const char *name;   /* as in the Verilog */
    uint32_t bits;
    uint32_t direction; /* AFU_INPUT or AFU_OUTPUT */
    void *address;      /* valid as long as its instance */
} afu_port;

typedef struct afu_instance afu_instance;

typedef struct afu_table {
    uint32_t abi;           /* AFU_ABI; nothing below may be read if it differs */
    uint32_t trace;         /* the kind of waveform that this model can write: AFU_TRACE_* */
    const char *rtl_sha256; /* of the Verilog that the model was made from, in lower-case hex */

    /* Returns NULL on an error; `error(NULL)` then gives its text on the same thread. With seed 0, everything that no
     * reset reaches begins as zero, otherwise as random bits from that seed. */
    afu_instance *(*create)(uint64_t seed);
    void (*destroy)(afu_instance *);

    /* Returns `*count` ports in the order of the Verilated header. The instance owns them. */
    const afu_port *(*ports)(afu_instance *, uint32_t *count);

    /* Settles the model after ports were written. */
    int (*evaluate)(afu_instance *);

    /* Runs `cycles` full cycles of the one-bit input `port` (an index into `ports`): high, evaluate, low, evaluate.
     * Each edge is written to the open waveform. */
    int (*clock)(afu_instance *, uint32_t port, uint64_t cycles);

    /* Writes a waveform to `path` from now on; `half_period_ps` is half a period of `clock`. Another may follow. */
    int (*trace_open)(afu_instance *, const char *path, uint64_t half_period_ps);
    int (*trace_close)(afu_instance *);

    /* Returns the text of the last error: never NULL, valid until the next call with the same instance (or thread). */
    const char *(*error)(afu_instance *);
} afu_table;

/* The only symbol a model exports. */
__attribute__((visibility("default"))) const afu_table *afu_model(void);

#ifdef __cplusplus
}
#endif

#endif
