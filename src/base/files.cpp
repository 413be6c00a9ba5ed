// Files: mapping of inputs, and outputs that appear together by rename.
#include "kerf/files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace kerf {

/// Either a mapping or bytes of our own (standard input, pipes, devices).
struct InputFile::Body {
  void* mapping = nullptr;
  std::size_t size = 0;
  std::string own;

  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
#if defined(__unix__) || defined(__APPLE__)
    if (mapping != nullptr) munmap(mapping, size);
#endif
  }
};

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16;  // bytes a read

/// Reads a stream to its end into `bytes`; false once more than `limit` bytes came.
bool read_all(std::FILE* stream, std::size_t limit, std::string& bytes) {
  for (;;) {
    const std::size_t had = bytes.size();
    bytes.resize(had + kChunk);
    const std::size_t got = std::fread(bytes.data() + had, 1, kChunk, stream);
    bytes.resize(had + got);
    if (bytes.size() > limit) return false;
    if (got == 0) return true;
  }
}

void too_large(const std::string& path, std::size_t limit, Diagnostics& diagnostics) {
  diagnostics.error(Code::file_too_large, TextSpot{path, 0, 0},
                    fmt::format("the file is larger than {} bytes, the most that is read at once", limit));
}

void unreadable(const std::string& path, std::string_view why, Diagnostics& diagnostics) {
  diagnostics.error(Code::file_unreadable, TextSpot{path, 0, 0},
                    fmt::format("cannot read the file: {}", why));
}

}  // namespace

InputFile::InputFile(std::string path, std::unique_ptr<Body> body)
    : path_(std::move(path)), body_(std::move(body)) {}
InputFile::InputFile(InputFile&&) noexcept = default;
InputFile& InputFile::operator=(InputFile&&) noexcept = default;
InputFile::~InputFile() = default;

std::string_view InputFile::bytes() const {
  if (body_->mapping != nullptr) return {static_cast<const char*>(body_->mapping), body_->size};
  return body_->own;
}

std::optional<InputFile> InputFile::open(const std::string& path, Diagnostics& diagnostics,
                                         std::size_t limit_bytes) {
  auto body = std::make_unique<Body>();
  if (path == "-") {
    if (!read_all(stdin, limit_bytes, body->own))
      return too_large(path, limit_bytes, diagnostics), std::nullopt;
    return InputFile("<stdin>", std::move(body));
  }
#if defined(__unix__) || defined(__APPLE__)
  const int handle = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (handle < 0 || fstat(handle, &status) != 0) {
    unreadable(path, std::strerror(errno), diagnostics);
    if (handle >= 0) ::close(handle);
    return std::nullopt;
  }
  if (S_ISDIR(status.st_mode)) {
    ::close(handle);
    return unreadable(path, "it is a folder", diagnostics), std::nullopt;
  }
  if (S_ISREG(status.st_mode) && static_cast<std::size_t>(status.st_size) > limit_bytes) {
    ::close(handle);
    return too_large(path, limit_bytes, diagnostics), std::nullopt;
  }
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    body->size = static_cast<std::size_t>(status.st_size);
    void* mapping = mmap(nullptr, body->size, PROT_READ, MAP_PRIVATE, handle, 0);
    if (mapping != MAP_FAILED) {
      body->mapping = mapping;
      ::close(handle);
      return InputFile(path, std::move(body));
    }
  }
  ::close(handle);
#endif
  std::FILE* stream = std::fopen(path.c_str(), "rb");
  if (stream == nullptr) return unreadable(path, std::strerror(errno), diagnostics), std::nullopt;
  const bool whole = read_all(stream, limit_bytes, body->own);
  const bool failed = std::ferror(stream) != 0;
  std::fclose(stream);
  if (failed) return unreadable(path, "reading stopped with an error", diagnostics), std::nullopt;
  if (!whole) return too_large(path, limit_bytes, diagnostics), std::nullopt;
  return InputFile(path, std::move(body));
}

OutputSet::~OutputSet() {
  for (const Pending& file : pending_) std::remove(file.temporary.c_str());
}

bool OutputSet::write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics) {
  static unsigned counter = 0;
#if defined(__unix__) || defined(__APPLE__)
  const auto process = static_cast<unsigned long>(getpid());
#else
  const unsigned long process = 0;
#endif
  std::string temporary = fmt::format("{}.{}-{}.part", path, process, ++counter);
  std::FILE* stream = std::fopen(temporary.c_str(), "wbx");
  bool good = stream != nullptr;
  if (good) {
    good = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
    good = std::fclose(stream) == 0 && good;
  }
  if (!good) {
    diagnostics.error(Code::file_unwritable, TextSpot{path, 0, 0},
                      fmt::format("cannot write the file: {}", std::strerror(errno)));
    if (stream != nullptr) std::remove(temporary.c_str());
    return false;
  }
  pending_.push_back({path, std::move(temporary)});
  return true;
}

bool OutputSet::commit(Diagnostics& diagnostics) {
  // What no renaming can replace is found before the first one, so that all files appear or none.
  for (const Pending& file : pending_) {
    std::error_code error;
    if (!std::filesystem::is_directory(file.target, error)) continue;
    diagnostics.error(Code::file_unwritable, TextSpot{file.target, 0, 0}, "a folder of this name is there");
    return false;
  }
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    std::error_code error;
    std::filesystem::rename(pending_[i].temporary, pending_[i].target, error);
    if (!error) continue;
    diagnostics.error(Code::file_unwritable, TextSpot{pending_[i].target, 0, 0},
                      fmt::format("cannot put the file into place: {}", error.message()));
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(i));
    return false;
  }
  pending_.clear();
  return true;
}

}  // namespace kerf
