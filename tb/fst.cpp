// Verilator's writer of FST files, which takes no notice of a file system that refuses, made to take it. This unit is
// compiled in the place of Verilator's own; its macros reach the calls in question and nothing else.

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>

// Whether anything could not be written since the last call, for writers that do not throw.
extern "C" bool afu_fst_failed();

#if defined(__has_include) && __has_include("fstcpp/fstcpp_writer.cpp")

// Its checks abort the process when a stream has failed: this one throws before they look.
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

// GTKWave's writer looks at no result, but a FILE remembers that one was bad until it is closed.
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

// It maps its temporary files, and a page that a full disk has no room for would be a bus error: they are memory, and
// mapped only if all of it could be had.
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
