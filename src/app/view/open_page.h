// Opening the page in the user's browser.
#pragma once

#include <string>

namespace kerf::app::view {

/// The address has a secret, and other users see the arguments of processes: the browser gets a private file
/// that leads to the address, which is removed with this.
class OpenedPage {
 public:
  OpenedPage() = default;
  ~OpenedPage();
  OpenedPage(const OpenedPage&) = delete;
  OpenedPage& operator=(const OpenedPage&) = delete;

  /// Starts $BROWSER, else xdg-open. False if the file cannot be written or no process can be started.
  bool open(const std::string& address);

 private:
  std::string folder_;
};

}  // namespace kerf::app::view
