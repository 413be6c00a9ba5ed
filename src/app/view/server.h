// The server of the page: on the loopback interface alone, for pages that know its token.
#pragma once

#include <memory>
#include <string>

#include "app/view/events.h"
#include "app/view/session.h"

namespace kerf::app::view {

class Server {
 public:
  Server(Session& session, Events& events, std::string token);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Takes a port of the loopback interface; 0: any free one. False if it is in use.
  bool bind(int port);
  int port() const;
  /// Answers requests on threads of its own.
  void start();
  /// Ends all answers; returns when they have ended.
  void stop();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace kerf::app::view
