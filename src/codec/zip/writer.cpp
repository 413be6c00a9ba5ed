// Writes a zip archive into memory.
#if KERF_WITH_ZIP

#include <algorithm>
#include <minizip/zip.h>
#include <utility>

#include "codec/zip/memory.h"
#include "codec/zip/zip.h"

namespace kerf::zip {
namespace {

/// Fast compression: higher levels take several times as long for little gain on meshes.
constexpr int kLevel = 3;

uLong write_memory(voidpf, voidpf stream, const void* from, uLong size) {
  auto& memory = Memory<std::string>::of(stream);
  if (memory.bytes.size() < memory.at + size) memory.bytes.resize(memory.at + size);
  std::copy_n(static_cast<const char*>(from), size, memory.bytes.data() + memory.at);
  memory.at += size;
  return size;
}

}  // namespace

struct Writer::Archive {
  Memory<std::string> memory;
  zipFile file = nullptr;
};

Writer::Writer() : archive_(std::make_unique<Archive>()) {
  auto calls = archive_->memory.calls(write_memory);
  archive_->file = zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &calls);
}

Writer::~Writer() {
  if (archive_->file != nullptr) zipClose(archive_->file, nullptr);
}

void Writer::begin(const char* name, Size size) {
  zip_fileinfo info{};
  info.tmz_date.tm_year = 1980;  // the earliest date of a zip, so that the bytes do not depend on the time
  info.tmz_date.tm_mday = 1;
  zipOpenNewFileInZip64(archive_->file, name, &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, kLevel,
                        static_cast<int>(size));
}

void Writer::write(std::string_view text) {
  zipWriteInFileInZip(archive_->file, text.data(), static_cast<unsigned>(text.size()));
}

void Writer::end() { zipCloseFileInZip(archive_->file); }

std::string Writer::finish() {
  zipClose(archive_->file, nullptr);
  archive_->file = nullptr;
  return std::move(archive_->memory.bytes);
}

}  // namespace kerf::zip

#endif  // KERF_WITH_ZIP
