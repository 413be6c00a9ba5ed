// A minizip file in memory: the callbacks for reading and writing.
#pragma once

#include <algorithm>
#include <minizip/ioapi.h>

namespace kerf::zip {

/// Bytes (growing or read-only) and an offset. The callbacks refer to this object, which must not move while
/// the zip is open.
template <class Bytes>
struct Memory {
  Bytes bytes;
  std::size_t at = 0;

  zlib_filefunc64_def calls(write_file_func write) {
    return {open, read, write, position, seek, nothing, nothing, this};
  }
  static Memory& of(voidpf stream) { return *static_cast<Memory*>(stream); }

 private:
  static voidpf open(voidpf opaque, const void*, int) { return opaque; }
  static uLong read(voidpf, voidpf stream, void* to, uLong size) {
    Memory& memory = of(stream);
    const std::size_t left = memory.bytes.size() - std::min(memory.at, memory.bytes.size());
    const std::size_t n = std::min<std::size_t>(size, left);
    std::copy_n(memory.bytes.data() + memory.at, n, static_cast<char*>(to));
    memory.at += n;
    return static_cast<uLong>(n);
  }
  static ZPOS64_T position(voidpf, voidpf stream) { return of(stream).at; }
  static long seek(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
    Memory& memory = of(stream);
    const std::size_t size = memory.bytes.size();
    const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? memory.at
                             : origin == ZLIB_FILEFUNC_SEEK_END ? size
                                                                : 0;
    const std::size_t to = from + static_cast<std::size_t>(offset);  // wraps for damaged files
    if (to > size) return -1;
    memory.at = to;
    return 0;
  }
  static int nothing(voidpf, voidpf) { return 0; }
};

}  // namespace kerf::zip
