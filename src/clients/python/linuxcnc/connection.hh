// SPDX-License-Identifier: GPL-2.0-or-later
// How the objects of this module find the machine: when they are first used, and never by waiting for it.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "messages/client/client.hh"
#include "messages/client/viewer.hh"

namespace mw::python {

/// A view of the machine. One for each Python object; guarded by the GIL.
class View {
  public:
    /// Joins the machine where it has not; throws linuxcnc.error when there is none, or when it is gone.
    client::Viewer &viewer();
    /// Throws linuxcnc.error when the machine has ended. Checks rarely while the status does not change, and
    /// never while it changes.
    void check_alive();
    bool isJoined() const { return viewer_.has_value(); }

  private:
    std::optional<client::Viewer> viewer_;
    std::uint64_t cycle_ = 0;  ///< at the last check
    std::chrono::steady_clock::time_point seen_{};
};

/// The machine that `linuxcnc.nmlfile` names, on this computer or another one. Releases the GIL. Throws
/// linuxcnc.error.
client::Viewer connect_viewer();

/// `linuxcnc.nmlfile`, empty where no program and no environment has set it.
std::string nml_file();

/// A machine that is ready for clients. Throws linuxcnc.error.
client::Client connect_client();

}  // namespace mw::python
