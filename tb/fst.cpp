// Verilator's writer of FST files ignores errors of the file system. This unit is compiled in its place and reports
// them. Its macros replace only the calls that matter.

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

// True if a write failed since the last call, for writers that do not throw.
extern "C" bool afu_fst_failed();

#if defined(__has_include) && __has_include("fstcpp/fstcpp_writer.cpp")

// The writer's checks abort the process when a stream has failed. This stream throws before they are reached.
struct afu_fst_stream : std::ofstream {
    afu_fst_stream() { exceptions(std::ios::badbit | std::ios::failbit); }
};
namespace std {
using ::afu_fst_stream;
}
#define ofstream afu_fst_stream
#include "verilated_fst_c.cpp"
#undef ofstream

extern "C" bool afu_fst_failed() { return false; }

#else

#include <stdexcept>
#include <sys/mman.h>
#include <sys/stat.h>
#include <zlib.h>

// GTKWave's writer ignores results, but a FILE keeps its error flag until it is closed.
static thread_local bool afu_fst_bad = false;

static int afu_fst_fclose(FILE *file) {
    if (std::ferror(file)) afu_fst_bad = true;
    const int result = std::fclose(file);
    if (result != 0) afu_fst_bad = true;
    return result;
}

static int afu_fst_gzclose(gzFile file) {
    const int result = gzclose(file);
    if (result != Z_OK) afu_fst_bad = true;
    return result;
}

// The writer maps its temporary files, and a page without room on a full disk would be a bus error. Here these files
// are in memory, and are mapped only if they have their full size.
static FILE *afu_fst_tmpfile() {
#ifdef __linux__
    const int descriptor = memfd_create("afu-fst", 0);
    if (descriptor >= 0) return fdopen(descriptor, "w+b");
#endif
    return std::tmpfile();
}

static void *afu_fst_mmap(void *at, size_t length, int protection, int flags, int descriptor, off_t offset) {
    struct stat file;
    const bool fits = fstat(descriptor, &file) == 0 && static_cast<size_t>(file.st_size) >= length;
    if (!fits) throw std::runtime_error("no room for its temporary files");
    return mmap(at, length, protection, flags, descriptor, offset);
}

#define mmap(at, length, protection, flags, descriptor, offset) \
    afu_fst_mmap(at, length, protection, flags, descriptor, offset)
#define fclose(file) afu_fst_fclose(file)
#define gzclose(file) afu_fst_gzclose(file)
#define tmpfile() afu_fst_tmpfile()
#include "verilated_fst_c.cpp"
#undef mmap
#undef fclose
#undef gzclose
#undef tmpfile

extern "C" bool afu_fst_failed() {
    const bool failed = afu_fst_bad;
    afu_fst_bad = false;
    return failed;
}

#endif
