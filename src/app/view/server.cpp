// HTTP: the routes of web/PROTOCOL.md. The HTTP library is included here alone, because it is slow to
// compile.
#include "app/view/server.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <fmt/format.h>
#include <httplib.h>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "app/shown/downloads.h"
#include "app/shown/file_name.h"
#include "app/view/access.h"
#include "app/view/folder.h"
#include "app/view/page.h"
#include "base/file_names.h"
#include "job/record/record.h"

#include "kerf/drawing/svg.h"

namespace kerf::app::view {
namespace {

using std::chrono::milliseconds;

constexpr const char* kHost = "127.0.0.1";
constexpr int kFirstPort = 8347, kUsualPorts = 8;
constexpr const char* kRetry = "retry: 500\n";  // ms, after which a page tries again to connect
constexpr const char* kJson = "application/json; charset=utf-8";
constexpr const char* kBinary = "application/octet-stream";
constexpr int kMaxPages = 8;                                    // that wait for events; each takes a thread
constexpr std::size_t kMaxRequestBody = std::size_t{64} << 20;  // bytes, of a file that a page uploads
constexpr std::size_t kMaxConnections = 400;                    // each takes a thread while it is open
constexpr int kBacklog = 128;                                   // connections that wait to be accepted
constexpr int kTimeout = 5;              // seconds for a request to arrive, and for each write
constexpr milliseconds kEventWait{500};  // between checks whether the server ends
constexpr int kWaitsPerSign = 10;        // then a comment is sent, which fails if the page is closed
constexpr int kForbidden = 403, kNotFound = 404, kBad = 400, kNotNow = 204, kConflict = 409, kTooLarge = 413,
              kLongAddress = 414, kBusy = 503;

// A second server on the same port must fail. SO_REUSEADDR allows that on Windows, and elsewhere lets a
// server start while the connections of the previous one are being closed.
#if defined(SO_EXCLUSIVEADDRUSE)
constexpr int kPortOption = SO_EXCLUSIVEADDRUSE;
#else
constexpr int kPortOption = SO_REUSEADDR;
#endif

/// A large body without a copy, and without compression, which takes longer than the loopback interface.
void send(httplib::Response& response, std::string body, const std::string& type) {
  auto kept = std::make_shared<const std::string>(std::move(body));
  if (kept->empty()) return response.set_content("", type);
  response.set_content_provider(kept->size(), type,
                                [kept](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(kept->data() + offset, length);
                                });
}

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(Record{{"error", why}}.text(Layout::line), kJson);
}

/// Why the HTTP library has refused a request.
std::string reason_of(int status) {
  switch (status) {
    case kBad: return "the request is malformed";
    case kTooLarge: return fmt::format("larger than {} MB", kMaxRequestBody >> 20);
    case kLongAddress: return "the address is too long";
    default: return "there is no such page";
  }
}

Sender sender_of(const httplib::Request& request) {
  Sender sender{request.get_header_value("Host"), request.get_header_value("Origin"),
                request.get_header_value("X-Kerf-Token")};
  if (request.has_param("t")) sender.token = request.get_param_value("t");
  return sender;
}

/// The revision that a page has, 0 if it says none; nothing, with an answer, if it is not a number.
std::optional<std::uint32_t> since_of(const httplib::Request& request, httplib::Response& response) {
  const std::string text = request.get_param_value("since");
  const auto since = parse_number(text.empty() ? "0" : text);
  if (!since) refuse(response, kBad, "since must be a revision");
  return since;
}

}  // namespace

/// A thread for each connection that waits: slow ones do not keep others from being answered.
class Connections : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    tasks_.push_back(std::move(task));
    if (tasks_.size() > idle_ && threads_.size() < kMaxConnections) threads_.emplace_back([this] { work(); });
    lock.unlock();
    wake_.notify_one();
  }
  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    for (;;) {
      ++idle_;
      wake_.wait(lock, [&] { return ended_ || !tasks_.empty(); });
      --idle_;
      if (tasks_.empty()) return;
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> tasks_;
  std::vector<std::thread> threads_;
  std::size_t idle_ = 0;
  bool ended_ = false;
};

struct Server::Inside {
  Session& session;
  Events& events;
  std::string token;
  httplib::Server http;
  const std::string run = random_token();  // its identity: pages of another run start afresh
  int port = 0;
  std::thread thread;
  socket_t listening = INVALID_SOCKET;
  std::atomic<bool> has_ended{false};  // the thread
  std::atomic<int> pages{0};
  std::mutex downloading;  // one at a time: each may take all of the machine
  std::mutex opening;      // of folder
  Folder folder;
  std::set<std::string> scripts;  // that may run: the first program, and those that the user has allowed

  Inside(Session& of, Events& from, std::string its_token)
      : session(of), events(from), token(std::move(its_token)), folder(of.options().file) {
    if (const auto path = canonical_path(of.options().file)) scripts.insert(*path);
  }

  void set_limits();
  void set_checks();
  void set_routes();
  void send_page(httplib::Response& response) const;
  void send_mesh(const httplib::Request& request, httplib::Response& response) const;
  void send_source(const httplib::Request& request, httplib::Response& response) const;
  void send_path(const httplib::Request& request, httplib::Response& response) const;
  void send_state_at(const httplib::Request& request, httplib::Response& response);
  void send_events(httplib::Response& response);
  void send_download(const httplib::Request& request, httplib::Response& response);
  void send_export(httplib::Response& response);
  void send_names(httplib::Response& response);
  void open_file(const httplib::Request& request, httplib::Response& response);
  void open_upload(const httplib::Request& request, httplib::Response& response);
  std::string present_state() const;
};

void Server::Inside::set_limits() {
  http.new_task_queue = [] { return new Connections; };
  http.set_payload_max_length(kMaxRequestBody);
  http.set_read_timeout(kTimeout);
  http.set_write_timeout(kTimeout);
  http.set_keep_alive_timeout(kTimeout);
  http.set_tcp_nodelay(true);
  http.set_socket_options([this](socket_t socket) {
    listening = socket;
    // The library's own options would let two servers share a port.
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, kPortOption, reinterpret_cast<const char*>(&yes), sizeof yes);
  });
  http.set_default_headers({{"Cache-Control", "no-store"},
                            {"X-Content-Type-Options", "nosniff"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cross-Origin-Opener-Policy", "same-origin"},
                            {"Cross-Origin-Embedder-Policy", "require-corp"},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"X-Kerf-Run", run}});
}

void Server::Inside::set_checks() {
  using Next = httplib::Server::HandlerResponse;
  http.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
    const std::string why = refusal(sender_of(request), port, token);
    if (why.empty()) return Next::Unhandled;
    refuse(response, kForbidden, why);
    return Next::Handled;
  });
  http.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.body.empty()) refuse(response, response.status, reason_of(response.status));
  });
  http.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
    refuse(response, kBusy, "out of memory");
  });
}

void Server::Inside::send_page(httplib::Response& response) const {
  Page page = served_page(session.options().frame_origins);
  response.set_header("Content-Security-Policy", page.policy);
  send(response, std::move(page.html), "text/html; charset=utf-8");
}

void Server::Inside::send_path(const httplib::Request& request, httplib::Response& response) const {
  if (const auto since = since_of(request, response))
    send(response, session.shown()->path->body(*since), kBinary);
}

void Server::Inside::send_source(const httplib::Request& request, httplib::Response& response) const {
  const auto id = parse_number(request.get_param_value("id"));
  if (!id) return refuse(response, kBad, "id must be the number of a block");
  const auto block = session.shown()->source_block(*id);
  if (!block) return refuse(response, kNotFound, "there is no such block of a source any more");
  send(response, *block, "text/plain; charset=utf-8");
}

void Server::Inside::send_mesh(const httplib::Request& request, httplib::Response& response) const {
  const auto since = since_of(request, response);
  if (!since) return;
  const auto shown = session.shown();
  send(response, shown->tiles.changed_since(*since, shown->revision), kBinary);
}

void Server::Inside::send_state_at(const httplib::Request& request, httplib::Response& response) {
  const auto step = parse_number(request.get_param_value("step"));
  const auto from = request.has_param("from") ? parse_number(request.get_param_value("from"))
                                              : std::optional<std::uint32_t>(kWholeJob);
  if (!step || !from) return refuse(response, kBad, "step and from must be numbers of steps");
  auto body = session.at(*step, *from);
  if (!body) return refuse(response, kNotFound, "the part has no states");
  if (body->empty()) {
    response.status = kNotNow;
  } else {
    send(response, std::move(*body), kBinary);
  }
}

/// What a page needs to know when it connects.
std::string Server::Inside::present_state() const {
  const auto shown = session.shown();
  std::string text = kRetry + event_text("run", Record{{"run", run}}.text(Layout::line));
  if (shown->revision > 0) text += event_text("model", model_event(*shown, shown->tiles.tiles().size()));
  if (shown->exact) text += event_text("exact", exact_event(*shown));
  if (shown->state == State::failed) text += event_text("errors", errors_event(*shown));
  if (const std::string work = session.work(); !work.empty()) text += event_text("progress", work);
  return text;
}

void Server::Inside::send_events(httplib::Response& response) {
  if (++pages > kMaxPages) {
    --pages;
    return refuse(response, kBusy, "too many pages are open");
  }
  struct Reader {
    std::uint64_t newest;
    int waits = 0;
    bool greeted = false;
  };
  auto reader = std::make_shared<Reader>(Reader{events.newest()});
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, reader](std::size_t, httplib::DataSink& sink) {
        const auto batch = events.wait(reader->newest, reader->greeted ? kEventWait : milliseconds(0));
        if (!batch) return false;
        std::string text = batch->text;
        if (!reader->greeted || batch->has_missed) text = present_state();
        reader->newest = batch->newest;
        reader->greeted = true;
        if (text.empty() && ++reader->waits % kWaitsPerSign == 0) text = ": waiting\n\n";
        return text.empty() || sink.write(text.data(), text.size());
      },
      [this](bool) { --pages; });
}

void Server::Inside::send_download(const httplib::Request& request, httplib::Response& response) {
  const std::lock_guard lock(downloading);
  Download file =
      make_download(*session.shown(),
                    {request.matches[1], request.get_param_value("post"), request.get_param_value("view")},
                    session.options().threads);
  if (!file.problem.empty()) return refuse(response, kNotFound, file.problem);
  response.set_header("Content-Disposition", "attachment; filename=\"" + file.name + "\"");
  send(response, std::move(file.bytes), file.type);
}

void Server::Inside::send_export(httplib::Response& response) {
  const auto shown = session.shown();
  if (!shown->job) return refuse(response, kNotFound, "there is no part yet");
  const std::string name = download_name(file_name_of(shown->job->program.source));
  response.set_header("Content-Disposition", "attachment; filename=\"" + name + ".html\"");
  send(response, exported_page(session), "text/html; charset=utf-8");
}

void Server::Inside::send_names(httplib::Response& response) {
  const std::lock_guard lock(opening);
  Record names = Record::array();
  for (const std::string& name : folder.names()) names.push_back(name);
  send(response, Record{{"files", std::move(names)}}.text(Layout::line), kJson);
}

void Server::Inside::open_file(const httplib::Request& request, httplib::Response& response) {
  if (!request.body.empty()) return refuse(response, kTooLarge, "no body is expected");
  const std::lock_guard lock(opening);
  const auto path = folder.find(request.get_param_value("src"));
  if (!path) return refuse(response, kNotFound, "there is no such file in the folder of the program");
  if (request.get_param_value("run") == "yes") scripts.insert(*path);
  if (is_script(*path) && scripts.count(*path) == 0)
    return refuse(response, kConflict, "a script runs with all rights of its user: it must be allowed first");
  session.open(*path);
  send(response, "{}", kJson);
}

void Server::Inside::open_upload(const httplib::Request& request, httplib::Response& response) {
  const std::lock_guard lock(opening);
  const Folder::Kept kept = folder.keep(request.get_param_value("name"), request.body);
  if (!kept.problem.empty()) return refuse(response, kBad, kept.problem);
  session.open(kept.path);
  send(response, "{}", kJson);
}

void Server::Inside::set_routes() {
  using Request = httplib::Request;
  using Response = httplib::Response;
  http.Get("/", [this](const Request&, Response& response) { send_page(response); });
  http.Get("/events", [this](const Request&, Response& response) { send_events(response); });
  http.Get("/model", [this](const Request&, Response& response) {
    const auto shown = session.shown();
    if (!shown->timing.empty()) response.set_header("Server-Timing", shown->timing);
    send(response, model_body(*shown), kJson);
  });
  http.Get("/mesh", [this](const Request& request, Response& response) { send_mesh(request, response); });
  http.Get("/path", [this](const Request& request, Response& response) { send_path(request, response); });
  http.Get("/source", [this](const Request& request, Response& response) { send_source(request, response); });
  http.Get("/exact", [this](const Request&, Response& response) {
    const auto shown = session.shown();
    if (!shown->exact) {
      response.status = kNotNow;
    } else {
      send(response, *shown->exact, kBinary);
    }
  });
  http.Get("/target", [this](const Request&, Response& response) {
    const auto shown = session.shown();
    if (!shown->target) return refuse(response, kNotFound, "there is no target");
    send(response, *shown->target, kBinary);
  });
  http.Get("/at", [this](const Request& request, Response& response) { send_state_at(request, response); });
  http.Get(R"(/download/([a-z0-9]{1,8}))",
           [this](const Request& request, Response& response) { send_download(request, response); });
  http.Get("/export", [this](const Request&, Response& response) { send_export(response); });
  http.Get("/files", [this](const Request&, Response& response) { send_names(response); });
  http.Post("/open", [this](const Request& request, Response& response) { open_file(request, response); });
  http.Post("/drop", [this](const Request& request, Response& response) { open_upload(request, response); });
  http.Post("/unit", [this](const Request& request, Response& response) {
    if (!request.body.empty()) return refuse(response, kTooLarge, "no body is expected");
    const std::optional<Length> unit = drawing_unit(request.get_param_value("unit"));
    if (!unit) return refuse(response, kBad, "unit must be mm, inch, px or pt");
    session.use_unit(*unit);
    send(response, "{}", kJson);
  });
  http.Post("/stop", [this](const Request& request, Response& response) {
    if (!request.body.empty()) return refuse(response, kTooLarge, "no body is expected");
    session.stop_work();
    send(response, "{}", kJson);
  });
}

Server::Server(Session& session, Events& events, std::string token)
    : inside_(std::make_unique<Inside>(session, events, std::move(token))) {
  inside_->set_limits();
  inside_->set_checks();
  inside_->set_routes();
}

Server::~Server() { stop(); }

bool Server::bind(int port) {
  Inside& s = *inside_;
  if (port != 0) {
    s.port = port;
    return s.http.bind_to_port(kHost, port);
  }
  // The browser keeps settings by port: the usual ones are tried first.
  for (s.port = kFirstPort; s.port < kFirstPort + kUsualPorts; ++s.port)
    if (s.http.bind_to_port(kHost, s.port)) return true;
  s.port = s.http.bind_to_any_port(kHost);
  return s.port > 0;
}

int Server::port() const { return inside_->port; }

void Server::start() {
  Inside& s = *inside_;
  s.thread = std::thread([&s] {
    s.http.listen_after_bind();
    s.has_ended = true;
  });
  // Until it listens, stop() of the HTTP library has no effect, and joining the thread would wait for ever.
  while (!s.http.is_running() && !s.has_ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (s.listening != INVALID_SOCKET) ::listen(s.listening, kBacklog);  // the library asks for 5
}

void Server::stop() {
  inside_->events.close();
  inside_->http.stop();
  if (inside_->thread.joinable()) inside_->thread.join();
}

}  // namespace kerf::app::view
