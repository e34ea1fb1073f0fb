// SPDX-License-Identifier: GPL-2.0-or-later
// Small files of the machine that screens read and write: lines of MDI, preferences, the picture, offsets of
// all systems.
#pragma once

#include <string>
#include <string_view>

#include "clients/screen/facts/machine_facts.hh"
#include "clients/screen/http/http_types.hh"

namespace mw::screen {

/// Reads and writes files, in a thread other than the server's.
class UserFiles {
  public:
    /// Maximum number of stored MDI lines.
    static constexpr std::size_t MOST_LINES = 500;

    explicit UserFiles(const MachineFacts &facts) : facts_(facts) {}

    /// GET {"lines": [...]}, oldest first; PUT the same document. The file is text with one line each, as for
    /// other screens.
    Response mdi_history(const Request &request) const;
    /// GET, PUT a JSON object. An existing file of another screen, which is not an object, is not changed:
    /// 409.
    Response preferences(const Request &request) const;
    Response icon() const;
    /// {"systems": [{"offset": [X, Y, Z, A, B, C, U, V, W], "rotation_deg": 0}, ...]} of G54 to G59.3, from
    /// the parameter file.
    Response offsets() const;
    /// The certificate of motion of the last program, as written by the machine.
    Response certificate() const;

  private:
    MachineFacts facts_;
};

}  // namespace mw::screen
