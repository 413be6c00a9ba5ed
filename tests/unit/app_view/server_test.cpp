// Starting and stopping the server.
#include "app/view/server.h"

#include <gtest/gtest.h>

namespace kerf::app::view {
namespace {

TEST(Server, StopsAtAnyTimeAfterItsStart) {
  for (int k = 0; k < 200; ++k) {
    Events events;
    SessionOptions options;
    options.file = "part.nc";
    Session session(options, events);
    Server server(session, events, "abcdefghijklmnop");
    ASSERT_TRUE(server.bind(0));
    server.start();
    server.stop();  // a signal may come at once
  }
}

}  // namespace
}  // namespace kerf::app::view
