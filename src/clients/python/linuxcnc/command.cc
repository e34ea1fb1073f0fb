// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/command.hh"

#include <pybind11/pybind11.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "clients/python/linuxcnc/connection.hh"
#include "clients/python/linuxcnc/module.hh"
#include "clients/python/linuxcnc/stat_words.hh"
#include "messages/mailbox/stops.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

constexpr double TAKEN_WITHIN_S = 5.0;
constexpr double USUAL_TIMEOUT_S = 5.0;
constexpr double SHOWN_WITHIN_S = 0.5;
/// Duration for which a stop is shown. After stops other than aborts, a paused program remains active, and
/// other axes may continue to jog.
constexpr double STOP_SHOWN_WITHIN_S = 0.03;
constexpr double HOMING_PATIENCE_S = 0.5;
/// Interval of checks for a signal to Python (Ctrl-C) during a sleep.
constexpr double LONGEST_SLEEP_S = 0.2;
constexpr int TIME_IS_OVER = -1;

}  // namespace

client::Client &Command::client() {
    if (client_.has_value() && !client_->isMachineAlive()) {
        client_.reset();
    }
    if (!client_.has_value()) {
        client_.emplace(connect_client());
    }
    return *client_;
}

template <class Act>
void Command::away(const Act &act) {
    while (busy_) {  // another thread of this program waits with the same object
        py::gil_scoped_release release;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    busy_ = true;
    {
        py::gil_scoped_release release;
        act();
    }
    busy_ = false;
    if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
    }
}

void Command::refuse(const std::string &reason) {
    isRefused_ = true;
    auto posted = client_->post(messages::OperatorError{reason});
    serial_ = posted.has_value() ? *posted : serial_;
}

void Command::send(const messages::Command &command) {
    client::Client &to = client();
    homing_ = std::holds_alternative<messages::HomeJoint>(command);
    isStop_ = mailbox::isStop(command);
    abort_ = std::holds_alternative<messages::AbortAll>(command);
    isRefused_ = false;
    away([&] {
        const auto posted = to.post(command);
        if (!posted.has_value()) {
            refuse(posted.error().str());
            return;
        }
        serial_ = *posted;
        // Waits for the status of the cycle that accepted the command, so that a later poll contains it.
        const auto isShown = [&] {
            return to.read_status().has_value() && to.status().last_command >= serial_;
        };
        if (to.wait_taken(serial_, TAKEN_WITHIN_S).has_value()) {
            static_cast<void>(to.wait_until(isShown, TAKEN_WITHIN_S));
        }
    });
}

void Command::send_and_look(const messages::Command &command) {
    constexpr double MOMENT_S = 0.01;
    send(command);
    if (!isRefused_) {
        away([&] {
            const auto ended = client_->wait(serial_, MOMENT_S);
            if (ended.has_value() && ended->progress != messages::Progress::STARTED) {
                show_end(isStop_ ? STOP_SHOWN_WITHIN_S : SHOWN_WITHIN_S);
            }
        });
    }
}

/// Waits until the status shows the end. An outcome is reported before the status of its cycle, and the queue
/// of motion shows the end one cycle later; the next poll must show that no work is active.
bool Command::show_end(double seconds) {
    const auto isShown = [this] {
        const bool is_read = client_->read_status().has_value();
        const messages::MachineStatus &status = client_->status();
        return is_read && (status.last_command != serial_ || rcs_state(status) != RcsState::EXEC);
    };
    return client_->wait_until(isShown, seconds).has_value();
}

int Command::wait_complete(std::optional<double> timeout_s) {
    if (serial_ == 0) {
        return static_cast<int>(RcsState::DONE);
    }
    if (isRefused_) {
        return static_cast<int>(RcsState::ERROR);
    }
    const bool is_short = homing_ && !timeout_s.has_value();
    double left_s = is_short ? HOMING_PATIENCE_S : std::max(0.0, timeout_s.value_or(USUAL_TIMEOUT_S));
    client::Outcome outcome;
    bool at_rest = !abort_;
    while (true) {
        const double slice_s = std::min(left_s, LONGEST_SLEEP_S);
        away([&] {
            if (const auto ended = client_->wait(serial_, slice_s); ended.has_value()) {
                outcome = *ended;
            }
            if (outcome.progress == messages::Progress::STARTED) {
                return;
            }
            if (!at_rest) {  // axes still brake
                at_rest = outcome.progress != messages::Progress::DONE || show_end(slice_s);
            } else {
                show_end(isStop_ ? STOP_SHOWN_WITHIN_S : SHOWN_WITHIN_S);
            }
        });
        left_s -= slice_s;
        if (outcome.progress != messages::Progress::STARTED && at_rest) {
            const bool done = outcome.progress == messages::Progress::DONE;
            return static_cast<int>(done ? RcsState::DONE : RcsState::ERROR);
        }
        if (left_s <= 0) {
            return is_short ? static_cast<int>(RcsState::DONE) : TIME_IS_OVER;
        }
    }
}

}  // namespace mw::python
