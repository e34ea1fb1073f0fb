// SPDX-License-Identifier: GPL-2.0-or-later
// The data that all connections see of the machine: its status, and lines for the operator that each
// connection receives.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "messages/client/viewer.hh"

namespace mw::rsh {

/// Position of a connection in the lines, for each type.
using ReadUpTo = std::array<std::uint64_t, 3>;

/// All calls come from one thread.
class SharedView {
  public:
    explicit SharedView(client::Viewer viewer) : viewer_(std::move(viewer)) {}

    /// Updates status and lines.
    Result<> read();
    const messages::MachineStatus &status() const { return viewer_.status(); }
    bool isMachineAlive() const { return viewer_.isMachineAlive(); }
    Result<> check_machine() const { return viewer_.check_machine(); }

    /// Initial position of a connection: lines that no connection has read.
    ReadUpTo unread() const { return read_up_to_; }
    /// The next line of a type; nothing if there is none.
    std::optional<std::string> next_line(messages::MessageKind kind, ReadUpTo &own);

    /// Number of connections; their owner counts them.
    int num_sessions = 0;

  private:
    /// Maximum number of lines stored for connections, above the number read at once.
    static constexpr std::size_t MAX_LINES = 500;
    struct Line {
        std::uint64_t number = 0;
        messages::MessageKind kind = messages::MessageKind::OPERATOR_ERROR;
        std::string text;
    };

    client::Viewer viewer_;
    std::deque<Line> lines_;
    std::uint64_t newest_ = 0;
    ReadUpTo read_up_to_{};
};

}  // namespace mw::rsh
