// Files: mapping of inputs, and outputs that appear together by rename.
#include "kerf/files.h"

#include <algorithm>
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

Diagnostic& too_large(const std::string& path, std::size_t limit, Diagnostics& diagnostics) {
  return diagnostics.error(
      Code::file_too_large, TextSpot{path, 0, 0},
      fmt::format("the file is larger than {} bytes, the most that is read at once", limit));
}

void unreadable(const std::string& path, std::string_view why, Diagnostics& diagnostics) {
  diagnostics.error(Code::file_unreadable, TextSpot{path, 0, 0},
                    fmt::format("cannot read the file: {}", why));
}

/// Reads a stream to its end, of which nobody knows how far off it is. Nothing, with an error, where that
/// fails, takes more than `limit` bytes, or is stopped.
std::optional<std::string> read_stream(std::FILE* stream, const std::string& path, std::size_t limit,
                                       Diagnostics& diagnostics, Progress* progress) {
  limit = std::min(limit, InputFile::kLargestStream);
  std::string bytes, chunk(kChunk, '\0');
  for (;;) {
    const std::size_t got = std::fread(chunk.data(), 1, kChunk, stream);
    if (stop_requested(progress)) {
      diagnostics.error(Code::stopped, TextSpot{path, 0, 0}, "interrupted while reading");
      return std::nullopt;
    }
    if (got == 0) break;
    bytes.append(chunk, 0, got);
    if (bytes.size() <= limit) continue;
    too_large(path, limit, diagnostics).hint = "more than that is read from ordinary files only";
    return std::nullopt;
  }
  if (std::ferror(stream) == 0) return bytes;
  unreadable(path, std::strerror(errno), diagnostics);
  return std::nullopt;
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
                                         std::size_t limit_bytes, Progress* progress) {
  auto body = std::make_unique<Body>();
  const auto take_stream = [&](std::FILE* stream, const std::string& name) -> std::optional<InputFile> {
    auto bytes = read_stream(stream, name, limit_bytes, diagnostics, progress);
    if (!bytes) return std::nullopt;
    body->own = std::move(*bytes);
    return InputFile(name, std::move(body));
  };
  if (path == "-") return take_stream(stdin, "<stdin>");
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
  std::optional<InputFile> file = take_stream(stream, path);
  std::fclose(stream);
  return file;
}

namespace {

/// Where a link leads to, so that the link stays and its target is replaced; any other path as it is.
std::string followed(const std::string& path) {
  std::error_code failed;
  if (!std::filesystem::is_symlink(path, failed)) return path;
  const auto target = std::filesystem::weakly_canonical(path, failed);
  return failed ? path : target.string();
}

/// Pipes and devices are written to where they are: a file must not take their place.
bool can_be_replaced(const std::string& path) {
  std::error_code failed;
  const auto status = std::filesystem::status(path, failed);
  return !std::filesystem::is_other(status);
}

/// Writes and closes; false where the stream could not be opened or could not take all.
bool write_all(std::FILE* stream, std::string_view bytes) {
  if (stream == nullptr) return false;
  const bool taken = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size();
  return std::fclose(stream) == 0 && taken;
}

void unwritable(const std::string& path, Diagnostics& diagnostics) {
  diagnostics.error(Code::file_unwritable, TextSpot{path, 0, 0},
                    fmt::format("cannot write the file: {}", std::strerror(errno)));
}

}  // namespace

OutputSet::~OutputSet() {
  for (const Pending& file : pending_)
    if (!file.temporary.empty()) std::remove(file.temporary.c_str());
}

bool OutputSet::write(const std::string& path, std::string_view bytes, Diagnostics& diagnostics) {
  static unsigned counter = 0;
  const std::string target = followed(path);
  if (!can_be_replaced(target)) {
    pending_.push_back({target, {}, std::string(bytes)});
    return true;
  }
#if defined(__unix__) || defined(__APPLE__)
  const auto process = static_cast<unsigned long>(getpid());
#else
  const unsigned long process = 0;
#endif
  std::string temporary = fmt::format("{}.{}-{}.part", target, process, ++counter);
  std::FILE* stream = std::fopen(temporary.c_str(), "wbx");
  if (!write_all(stream, bytes)) {
    unwritable(path, diagnostics);
    if (stream != nullptr) std::remove(temporary.c_str());
    return false;
  }
  pending_.push_back({target, std::move(temporary), {}});
  return true;
}

bool OutputSet::put_in_place(const Pending& file, Diagnostics& diagnostics) const {
  if (file.temporary.empty()) {
    if (write_all(std::fopen(file.target.c_str(), "wb"), file.bytes)) return true;
    unwritable(file.target, diagnostics);
    return false;
  }
  std::error_code error;
  std::filesystem::rename(file.temporary, file.target, error);
  if (!error) return true;
  diagnostics.error(Code::file_unwritable, TextSpot{file.target, 0, 0},
                    fmt::format("cannot put the file into place: {}", error.message()));
  return false;
}

bool OutputSet::commit(Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (put_in_place(pending_[i], diagnostics)) continue;
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(i));
    return false;
  }
  pending_.clear();
  return true;
}

}  // namespace kerf
