// SPDX-License-Identifier: GPL-2.0-or-later
// Small files of the machine that screens read and keep: lines of MDI, preferences, the picture, offsets of
// all systems.
#pragma once

#include <string>
#include <string_view>

#include "clients/screen/http_types.hh"
#include "clients/screen/machine_facts.hh"

namespace mw::screen {

/// Reads and writes files: in a thread beside the server's.
class UserFiles {
  public:
    /// Lines of MDI that are kept.
    static constexpr std::size_t MOST_LINES = 500;

    explicit UserFiles(const MachineFacts &facts) : facts_(facts) {}

    /// GET {"lines": [...]}, oldest first; PUT the same. The file is text, a line each, as other screens have
    /// it.
    Response mdi_history(const Request &request) const;
    /// GET, PUT an object of JSON. A file that is there and is none, another screen's, is left as it is: 409.
    Response preferences(const Request &request) const;
    Response icon() const;
    /// {"systems": [{"offset": [X, Y, Z, A, B, C, U, V, W], "rotation_deg": 0}, ...]} of G54 to G59.3 as the
    /// parameter file has them.
    Response offsets() const;
    /// The certificate of motion of the last program, as the machine wrote it.
    Response certificate() const;

  private:
    MachineFacts facts_;
};

}  // namespace mw::screen
