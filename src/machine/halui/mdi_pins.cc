// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/halui/mdi_pins.hh"

#include <algorithm>
#include <utility>

namespace mw::halui {

using messages::Mode, messages::Progress;

void MdiPins::step(const std::vector<bool> &on, client::Client &client, const Ask &ask) {
    for (std::size_t i = 0; i < buttons_.size(); ++i) {
        if (buttons_[i].step(on[i])) {
            waiting_.push_back(i);
        }
    }
    if (!active_ && !waiting_.empty()) {
        active_ = true;
        before_ = client.status().task.mode;
        mode_order_ = before_ == Mode::MDI ? 0 : ask(messages::SetMode{Mode::MDI});
        const bool posted = before_ == Mode::MDI || mode_order_ != 0;
        if (!posted) {
            waiting_.clear();
        }
    }
    if (!active_ || !isModeSet(client)) {
        return;
    }
    for (; !waiting_.empty(); waiting_.pop_front()) {
        const client::Serial serial = ask(messages::Mdi{lines_[waiting_.front()]});
        if (serial != 0) {
            running_.push_back(serial);
        }
    }
    if (areOver(client)) {
        active_ = false;
        if (before_ != Mode::MDI && client.status().task.mode == Mode::MDI) {
            ask(messages::SetMode{before_});
        }
    }
}

/// If the mode was rejected, the line is not run.
bool MdiPins::isModeSet(client::Client &client) {
    if (mode_order_ == 0) {
        return true;
    }
    const Progress progress = client.outcome(mode_order_).progress;
    if (progress == Progress::STARTED) {
        return false;
    }
    mode_order_ = 0;
    if (progress != Progress::DONE) {
        waiting_.clear();
    }
    return true;
}

bool MdiPins::areOver(client::Client &client) {
    std::erase_if(running_, [&client](client::Serial serial) {
        return client.outcome(serial).progress != Progress::STARTED;
    });
    return running_.empty();
}

}  // namespace mw::halui
