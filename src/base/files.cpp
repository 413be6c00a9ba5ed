// Files: mapping of inputs, and outputs that appear together by rename.
#include "kerf/files.h"

#include <atomic>
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

// ---- outputs

namespace {

namespace fs = std::filesystem;

/// The file that a path means in the end: symbolic links are followed, also to what does not exist yet.
std::string followed(const std::string& path) {
  constexpr int kMostLinks = 40;
  fs::path at = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(at, error); ++i)
    at = at.parent_path() / fs::read_symlink(at, error);
  return at.string();
}

/// True for what cannot be replaced by another file: devices, pipes, folders.
bool is_special(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status);
}

std::string part_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
#if defined(__unix__) || defined(__APPLE__)
  const auto process = static_cast<unsigned long>(getpid());
#else
  const unsigned long process = 0;
#endif
  return fmt::format("{}.{}-{}.part", target, process, ++counter);
}

}  // namespace

struct OutputFile::Body {
  std::string path;       // as the user told it
  std::string target;     // links followed
  std::string temporary;  // empty where the target is written at once
  std::FILE* stream = nullptr;
  bool good = true;

  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  ~Body() {
    if (stream != nullptr) std::fclose(stream);
    if (!temporary.empty()) std::remove(temporary.c_str());
  }
  /// Tells of the first failure.
  bool fail(std::string_view what, std::string_view why, Diagnostics& diagnostics) {
    if (good)
      diagnostics.error(Code::file_unwritable, TextSpot{path, 0, 0}, fmt::format("{}: {}", what, why));
    return good = false;
  }
};

OutputFile::OutputFile(std::unique_ptr<Body> body) : body_(std::move(body)) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile& OutputFile::operator=(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

std::optional<OutputFile> OutputFile::create(const std::string& path, Diagnostics& diagnostics) {
  auto body = std::make_unique<Body>();
  body->path = path;
  const bool special = is_special(path);
  body->target = special ? path : followed(path);
  const std::string name = special ? body->target : part_name(body->target);
  body->stream = std::fopen(name.c_str(), special ? "wb" : "wbx");
  if (body->stream == nullptr) {
    body->fail("cannot write the file", std::strerror(errno), diagnostics);
    return std::nullopt;
  }
  if (!special) body->temporary = name;
  return OutputFile(std::move(body));
}

bool OutputFile::write(std::string_view bytes, Diagnostics& diagnostics) {
  if (!body_->good || body_->stream == nullptr) return false;
  if (std::fwrite(bytes.data(), 1, bytes.size(), body_->stream) == bytes.size()) return true;
  return body_->fail("cannot write the file", std::strerror(errno), diagnostics);
}

bool OutputFile::close(Diagnostics& diagnostics) {
  if (body_->stream == nullptr) return body_->good;
  const bool closed = std::fclose(std::exchange(body_->stream, nullptr)) == 0;
  return closed ? body_->good : body_->fail("cannot write the file", std::strerror(errno), diagnostics);
}

bool OutputFile::commit(Diagnostics& diagnostics) {
  if (!close(diagnostics)) return false;
  if (body_->temporary.empty()) return true;
  std::error_code error;
  fs::rename(body_->temporary, body_->target, error);
  if (error) return body_->fail("cannot put the file into place", error.message(), diagnostics);
  body_->temporary.clear();
  return true;
}

bool OutputSet::write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics) {
  auto file = OutputFile::create(path, diagnostics);
  if (!file || !file->write(bytes, diagnostics) || !file->close(diagnostics)) return false;
  files_.push_back(std::move(*file));
  return true;
}

bool OutputSet::commit(Diagnostics& diagnostics) {
  bool good = true;
  for (OutputFile& file : files_) good = good && file.commit(diagnostics);
  files_.clear();
  return good;
}

}  // namespace kerf
