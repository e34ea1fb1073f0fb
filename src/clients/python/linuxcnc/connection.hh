// SPDX-License-Identifier: GPL-2.0-or-later
// Connects the objects of this module to the machine when they are first used, without waiting for it.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "messages/client/client.hh"
#include "messages/client/viewer.hh"

namespace mw::python {

/// A view of the machine, one for each Python object; guarded by the GIL.
class View {
  public:
    /// Joins the machine if not joined. Throws linuxcnc.error if there is no machine, or it has ended.
    client::Viewer &viewer();
    /// Throws linuxcnc.error if the machine has ended. Checks rarely while the status does not change, and
    /// never while it changes.
    void check_alive();
    bool isJoined() const { return viewer_.has_value(); }

  private:
    std::optional<client::Viewer> viewer_;
    std::uint64_t cycle_ = 0;  ///< cycle at the last check
    std::chrono::steady_clock::time_point seen_{};
};

/// The machine named by `linuxcnc.nmlfile`, on this computer or a remote one. Releases the GIL. Throws
/// linuxcnc.error.
client::Viewer connect_viewer();

/// `linuxcnc.nmlfile`; empty if neither a program nor the environment has set it.
std::string nml_file();

/// A client of a machine that is ready for clients. Throws linuxcnc.error.
client::Client connect_client();

}  // namespace mw::python
