// Opening the page in the user's browser.
#pragma once

#include <string>

#include "base/system.h"

namespace kerf::app::view {

/// The address has a secret, and other users see the arguments of processes: the browser gets a private file
/// that leads to the address, which is removed with this.
class OpenedPage {
 public:
  /// Starts $BROWSER, else the system's own browser. False if the file cannot be written or no process can be
  /// started.
  bool open(const std::string& address);

 private:
  TemporaryFolder folder_;
};

}  // namespace kerf::app::view
