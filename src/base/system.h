// What differs between operating systems, but for files (files.h) and processes (process.h): temporary
// folders, stamps of files, terminals, random numbers, the file of the command. A source file for POSIX, one
// for Windows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kerf {

/// A number that no other running process has.
unsigned long process_number();

/// The running program's file; nothing if the system does not report it.
std::optional<std::string> command_file();

enum class Stream { input, output, error };
/// Whether a person reads the stream.
bool is_terminal(Stream stream);

/// To be called by a program once, before it reads or writes: the streams transfer bytes unchanged, and a
/// terminal shows UTF-8 and executes control sequences.
void prepare_streams();

/// Fills `bytes`, at most 256, with the system's unpredictable random numbers. False if it has none.
bool fill_with_random_bytes(std::span<unsigned char> bytes);

/// Whether this process may write the file or the folder, which exists.
bool is_writable(const std::string& path);

/// Makes a folder that only this user can read. False if it exists already or cannot be made.
bool make_private_folder(const std::string& path);

/// The state of a file. Equal stamps: unchanged, as far as the system reports it.
struct FileStamp {
  bool exists = false;
  std::uint64_t device = 0, number = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0;
  bool operator==(const FileStamp&) const = default;
};
FileStamp file_stamp(const std::string& path);

/// A new empty folder in the folder for temporary files, which only this user can read. The destructor
/// removes it with all its files.
class TemporaryFolder {
 public:
  /// No folder.
  TemporaryFolder() = default;
  /// `name`: the start of the folder's name. path() is empty if there is no room for it.
  explicit TemporaryFolder(std::string_view name);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&& other) noexcept;
  ~TemporaryFolder();

  /// Empty: there is no folder.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace kerf
