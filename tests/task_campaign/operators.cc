// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/operators.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::task_campaign {
namespace {

/// For a session, in which all actions are short.
constexpr std::int64_t MOST_MS = 600000;

/// Replaces figures, so that rejections can be counted by reason.
std::string kind_of(const std::string &reason) {
    std::string out;
    for (const char c : reason) {
        const bool isFigure = (c >= '0' && c <= '9') || (c == '.' && !out.empty() && out.back() == '#');
        if (!isFigure) {
            out += c;
        } else if (out.empty() || out.back() != '#') {
            out += '#';
        }
    }
    const std::size_t path = out.find("/");
    return path == std::string::npos ? out : out.substr(0, path) + "...";
}

}  // namespace

void Operators::fail(const std::string &rule, const std::string &text) {
    if (verdict_.fault.empty()) {
        verdict_.fault =
            fmt::format("{}: {} (at {:.3f} s)", rule, text, 1e-3 * static_cast<double>(bench_.now_ms()));
    }
}

void Operators::tell(const std::string &text) const {
    if (tell_ != nullptr) {
        fmt::print(tell_, "{:.3f} {}\n", 1e-3 * static_cast<double>(bench_.now_ms()), text);
    }
}

void Operators::cycle() {
    if (isOver()) {
        return;
    }
    bench_.cycle();
    look_at_orders();
    wasAway_ = status().task.isAway;
    while (const auto message = tell_ != nullptr ? bench_.client(0).next_message() : std::nullopt) {
        tell("  says: " + message->text);
    }
    if (bench_.now_ms() > MOST_MS) {
        fail("time", "the session does not end");
    }
}

void Operators::cycles(int count) {
    for (int i = 0; i < count && !isOver(); ++i) {
        cycle();
    }
}

Operators::Serial Operators::post(int client, const messages::Command &command, Expected expected,
                                  std::int64_t patience_ms) {
    const auto posted = bench_.client(client).post(command);
    if (!posted.has_value()) {
        fail("post", posted.error().str());
        return 0;
    }
    const std::string name = std::visit(
        [](const auto &body) { return std::string(messages::DECLARED<std::decay_t<decltype(body)>>.name); },
        command);
    tell(fmt::format("{} posts {} ({})", client, name, *posted));
    ++verdict_.commands;
    const auto *mode = std::get_if<messages::SetMode>(&command);
    orders_.push_back({*posted, client, name, expected, bench_.now_ms(), patience_ms,
                       mode != nullptr ? std::optional(mode->mode) : std::nullopt,
                       std::holds_alternative<messages::ReleaseAxes>(command)});
    return *posted;
}

/// The order of commands that end in the same cycle is unknown: a mode may have been set before the end of
/// the run that set another mode.
void Operators::look_at_orders() {
    std::vector<std::pair<Order, client::Outcome>> ended;
    std::erase_if(orders_, [&](const Order &order) {
        const auto outcome = bench_.client(order.client).outcome(order.serial);
        const bool hasEnded = outcome.progress != messages::Progress::STARTED;
        if (hasEnded) {
            ended.emplace_back(order, outcome);
        }
        return hasEnded;
    });
    std::ranges::stable_partition(
        ended, [](const auto &one) { return one.second.progress == messages::Progress::DONE; });
    for (const auto &[order, outcome] : ended) {
        note_end(order, outcome);
    }
    for (const Order &order : orders_) {
        if (bench_.now_ms() > order.posted_ms + order.patience_ms) {
            fail("unended", fmt::format("{} has no end after {} ms: {}", order.name, order.patience_ms,
                                        what_it_waits_for()));
        }
    }
}

std::string Operators::what_it_waits_for() const {
    const messages::TaskStatus &task = status().task;
    const messages::TrajectoryStatus &motion = status().trajectory;
    return fmt::format(
        "interpreter {}, waits for {} {}, paused {}, motion paused {}, stepping {}, {} moves, at "
        "rest {}, line {}",
        static_cast<int>(task.interp_state), static_cast<int>(task.exec_state),
        static_cast<int>(task.waiting.what), task.isPaused, motion.isPaused, motion.isStepping,
        motion.queue_depth, motion.isInPosition, task.motion_line);
}

void Operators::note_end(const Order &order, const client::Outcome &outcome) {
    ended_[order.serial] = outcome;
    tell(fmt::format("  {} of {}: {} {}", order.serial, order.client, static_cast<int>(outcome.progress),
                     outcome.reason));
    const bool isRefused = outcome.progress == messages::Progress::REFUSED;
    if (outcome.progress == messages::Progress::DONE) {
        mode_ = order.mode.value_or(mode_);
        mode_under_way_ = order.mode ? std::nullopt : mode_under_way_;
    } else {
        const bool isOfJogs = order.isRelease || wasAway_;
        const auto begun = isOfJogs ? std::optional(messages::Mode::MANUAL) : order.mode;
        mode_under_way_ = begun && !isRefused ? begun : mode_under_way_;
        ++verdict_.refused;
        ++verdict_.refusals[kind_of(outcome.reason)];
        if (outcome.reason.empty()) {
            fail("reason", order.name + " is rejected without one");
        }
    }
    if (order.expected == Expected::TAKEN && isRefused) {
        fail("refusal", order.name + " is refused: " + outcome.reason);
    }
    if (order.expected == Expected::REFUSED && !isRefused) {
        fail("admission", order.name + " is taken");
    }
}

messages::Progress Operators::progress_of(Serial serial) const {
    const auto found = ended_.find(serial);
    return found != ended_.end() ? found->second.progress : messages::Progress::STARTED;
}

bool Operators::isWaited(Serial serial) const {
    return std::ranges::any_of(orders_, [serial](const Order &order) { return order.serial == serial; });
}

void Operators::forget_orders(int client) {
    for (const Order &order : orders_) {
        const bool isUnknown = client >= 0 && order.client == client && order.mode.has_value();
        mode_under_way_ = isUnknown ? order.mode : mode_under_way_;
    }
    std::erase_if(orders_, [client](const Order &order) { return client < 0 || order.client == client; });
    if (client < 0) {
        ended_.clear();  // another count starts
    }
}

messages::Progress Operators::ask(int client, const messages::Command &command, Expected expected) {
    const Serial serial = post(client, command, expected);
    while (!isOver() && progress_of(serial) == messages::Progress::STARTED) {
        cycle();
    }
    return progress_of(serial);
}

void Operators::nurse() {
    constexpr std::int64_t LOOKS_FOR_MS = 40;
    const bool isWaiting = status().task.isPaused && !isHeldByUs_;
    if (!isWaiting) {
        held_since_ms_ = -1;
        return;
    }
    held_since_ms_ = held_since_ms_ < 0 ? bench_.now_ms() : held_since_ms_;
    if (bench_.now_ms() < held_since_ms_ + LOOKS_FOR_MS) {
        return;
    }
    held_since_ms_ = -1;
    if (status().approach.number != 0) {
        post(1, messages::ConfirmApproach{status().approach.number});
    } else {
        post(2, messages::ResumeProgram{});
    }
}

void Operators::settle() {
    constexpr int MOST_CYCLES = 30000, REST_CYCLES = 5;
    *bench_.pins().chain = true;
    bench_.changer.isFaulted = false;
    isHeldByUs_ = false;
    int rest = 0;
    for (int i = 0; i < MOST_CYCLES && !isOver(); ++i) {
        nurse();
        cycle();
        const bool isQuiet = !isRunning() && orders_.empty() && *bench_.pins().in_position;
        rest = isQuiet ? rest + 1 : 0;
        if (rest > REST_CYCLES) {
            bench_.flush();
            return;
        }
    }
    if (!isOver()) {
        fail("rest", "the machine does not stop: " + what_it_waits_for());
    }
}

}  // namespace mw::task_campaign
