// Processes of Windows, each in a job that ends with it.
#include "base/process.h"

#if defined(_WIN32)
#include <map>
#include <optional>
#include <thread>
#include <windows.h>

#include "base/native_path.h"

namespace kerf {
namespace {

constexpr DWORD kPoll = 3;          // ms
constexpr DWORD kOthersRead = 0x1;  // other handles of the file can read

/// A word as the C runtime of the started program reads it.
std::wstring quoted(const std::string& word) {
  // cmd.exe does not know its options in quotes.
  if (!word.empty() && word.find_first_of(" \t\n\v\"") == std::string::npos) return wide(word);
  std::wstring out = L"\"";
  std::size_t slashes = 0;
  for (const wchar_t c : wide(word)) {
    if (c == L'\\') {
      ++slashes;
      continue;
    }
    out.append(c == L'"' ? 2 * slashes + 1 : slashes, L'\\');
    slashes = 0;
    out += c;
  }
  out.append(2 * slashes, L'\\');
  return out + L'"';
}

std::wstring command_line(const std::vector<std::string>& words) {
  std::wstring out;
  for (const std::string& word : words) out += (out.empty() ? L"" : L" ") + quoted(word);
  return out;
}

/// The block of this process's variables with those added.
std::wstring environment_block(const std::vector<std::pair<std::string, std::string>>& added) {
  std::map<std::wstring, std::wstring> variables;
  wchar_t* const present = GetEnvironmentStringsW();
  for (const wchar_t* at = present; *at != L'\0'; at += std::wcslen(at) + 1) {
    const std::wstring text = at;
    const std::size_t equals = text.find(L'=', 1);  // there are names such as =C:
    if (equals != std::wstring::npos) variables[text.substr(0, equals)] = text.substr(equals + 1);
  }
  FreeEnvironmentStringsW(present);
  for (const auto& [name, value] : added) variables[wide(name)] = wide(value);
  std::wstring block;
  for (const auto& [name, value] : variables) block += name + L"=" + value + L'\0';
  return block + L'\0';
}

/// A handle that the child may use, closed by the destructor.
class Handle {
 public:
  explicit Handle(HANDLE handle) : handle_(handle) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (is_open()) CloseHandle(handle_);
  }
  bool is_open() const { return handle_ != nullptr && handle_ != INVALID_HANDLE_VALUE; }
  HANDLE get() const { return handle_; }

 private:
  HANDLE handle_;
};

HANDLE output_file(const std::string& path) {
  if (path.empty()) return INVALID_HANDLE_VALUE;
  SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
  return CreateFileW(wide(path).c_str(), GENERIC_WRITE, kOthersRead, &inherited, CREATE_ALWAYS,
                     FILE_ATTRIBUTE_NORMAL, nullptr);
}

/// Whether the file has grown beyond the limit; Windows has no limit of its own.
bool is_too_long(HANDLE file, std::size_t limit) {
  LARGE_INTEGER size{};
  return limit != 0 && file != INVALID_HANDLE_VALUE && GetFileSizeEx(file, &size) != 0 &&
         static_cast<std::size_t>(size.QuadPart) >= limit;
}

/// Copies what comes through a pipe to standard error, and keeps its end.
class ErrorCopy {
 public:
  explicit ErrorCopy(std::string* end) : end_(end) {
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    if (end_ == nullptr || CreatePipe(&from_, &to_, &inherited, 0) == 0) return;
    SetHandleInformation(from_, HANDLE_FLAG_INHERIT, 0);
  }
  ErrorCopy(const ErrorCopy&) = delete;
  ErrorCopy& operator=(const ErrorCopy&) = delete;
  ~ErrorCopy() {
    close(to_);
    if (copier_.joinable()) copier_.join();
    close(from_);
  }

  HANDLE target() const { return to_; }  // null: there is no pipe
  void start() {
    close(to_);  // the child has its own
    if (from_ != nullptr) copier_ = std::thread([this] { copy(); });
  }

 private:
  static void close(HANDLE& handle) {
    if (handle != nullptr) CloseHandle(handle);
    handle = nullptr;
  }
  void copy() {
    char bytes[4096];
    DWORD count = 0, written = 0;
    while (ReadFile(from_, bytes, sizeof bytes, &count, nullptr) != 0 && count > 0) {
      WriteFile(GetStdHandle(STD_ERROR_HANDLE), bytes, count, &written, nullptr);
      end_->append(bytes, count);
      if (end_->size() > 2 * kErrorEnd) end_->erase(0, end_->size() - kErrorEnd);
    }
  }

  std::string* end_;
  HANDLE from_ = nullptr, to_ = nullptr;
  std::thread copier_;
};

STARTUPINFOW streams(const ProcessOptions& options, HANDLE file, HANDLE copy) {
  STARTUPINFOW start{};
  start.cb = sizeof(start);
  start.dwFlags = STARTF_USESTDHANDLES;
  start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
  start.hStdError = file != INVALID_HANDLE_VALUE ? file
                    : copy != nullptr            ? copy
                                                 : GetStdHandle(STD_ERROR_HANDLE);
  start.hStdOutput = file != INVALID_HANDLE_VALUE || options.output_to_error
                         ? start.hStdError
                         : GetStdHandle(STD_OUTPUT_HANDLE);
  return start;
}

/// A job: what runs in it ends with its last handle.
HANDLE new_job() {
  const HANDLE job = CreateJobObjectW(nullptr, nullptr);
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
  limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
  SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof(limits));
  return job;
}

}  // namespace

ProcessEnd run_process(const std::vector<std::string>& words, const ProcessOptions& options) {
  using Kind = ProcessEnd::Kind;
  std::wstring line = command_line(words), variables = environment_block(options.environment);
  // Outlives the job, which ends all writers.
  ErrorCopy copy(options.progress == nullptr ? options.error_end : nullptr);
  const Handle file(output_file(options.output_file)), job(new_job());
  STARTUPINFOW start = streams(options, file.get(), copy.target());
  PROCESS_INFORMATION made{};
  const DWORD flags = CREATE_UNICODE_ENVIRONMENT | CREATE_SUSPENDED;
  if (!CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, flags, variables.data(), nullptr, &start,
                      &made))
    return {GetLastError() == ERROR_FILE_NOT_FOUND ? Kind::not_found : Kind::not_started};
  const Handle process(made.hProcess), thread(made.hThread);
  AssignProcessToJobObject(job.get(), process.get());
  copy.start();
  ResumeThread(thread.get());
  while (WaitForSingleObject(process.get(), kPoll) == WAIT_TIMEOUT) {
    const bool stopped = stop_requested(options.progress);
    if (!stopped && !is_too_long(file.get(), options.output_limit)) continue;
    TerminateJobObject(job.get(), 1);
    if (stopped) return {Kind::stopped};
  }
  DWORD status = 1;
  GetExitCodeProcess(process.get(), &status);
  return {Kind::exited, static_cast<int>(status)};
}

bool start_detached(const std::vector<std::string>& words) {
  std::wstring line = command_line(words);
  STARTUPINFOW start{};
  start.cb = sizeof(start);
  PROCESS_INFORMATION made{};
  if (!CreateProcessW(nullptr, line.data(), nullptr, nullptr, FALSE, DETACHED_PROCESS, nullptr, nullptr,
                      &start, &made))
    return false;
  CloseHandle(made.hProcess);
  CloseHandle(made.hThread);
  return true;
}

}  // namespace kerf
#endif
