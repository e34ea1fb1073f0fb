// SPDX-License-Identifier: GPL-2.0-or-later
// Buttons for lines of the INI file. Each switches to MDI mode, runs the line and restores the mode.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "machine/halui/edge.hh"
#include "messages/client/client.hh"

namespace mw::halui {

class MdiPins {
  public:
    /// Posts a command; returns 0 when it could not be posted.
    using Ask = std::function<client::Serial(const messages::Command &)>;

    explicit MdiPins(std::vector<std::string> lines = {})
        : lines_(std::move(lines)), buttons_(lines_.size()) {}
    std::size_t count() const { return lines_.size(); }
    /// Called once in each cycle, with the state of each line's pin.
    void step(const std::vector<bool> &on, client::Client &client, const Ask &ask);
    /// Called after an abort: lines that wait for the mode are not run.
    void drop() { waiting_.clear(); }

  private:
    bool isModeSet(client::Client &client);
    bool areOver(client::Client &client);

    std::vector<std::string> lines_;
    std::vector<Edge> buttons_;
    std::deque<std::size_t> waiting_;      ///< pressed and not posted yet
    std::vector<client::Serial> running_;  ///< posted
    client::Serial mode_order_ = 0;
    bool active_ = false;
    messages::Mode before_ = messages::Mode::MANUAL;
};

}  // namespace mw::halui
