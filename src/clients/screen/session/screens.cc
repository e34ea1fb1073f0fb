// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/session/screens.hh"

#include <algorithm>
#include <random>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "clients/screen/access/access.hh"

namespace mw::screen {
namespace {

std::string random_name() {
    std::random_device random;
    return fmt::format("{:08x}{:08x}", random(), random());
}

/// The text of a message or note with its age. A screen shows its time by the screen's clock.
std::string aged(const std::string &text, std::int64_t age_ns) {
    constexpr std::int64_t NS_PER_MS = 1000000;
    return text.substr(0, text.size() - 1) + ",\"age_ms\":" + std::to_string(age_ns / NS_PER_MS) + '}';
}

}  // namespace

Screens::Screens(Sockets &sockets, ScreensSetup setup)
    : sockets_(sockets), setup_(std::move(setup)), session_(random_name()) {}

const messages::MachineStatus *Screens::status() const {
    return watch_.has_value() && has_status_ ? &watch_->status() : nullptr;
}

Result<messages::ToolTable> Screens::tools() {
    if (!watch_.has_value()) {
        return fail(reason_);
    }
    auto newer = watch_->read_tools();
    if (!newer.has_value()) {
        return std::unexpected(newer.error());
    }
    if (newer->has_value()) {
        tools_ = std::move(**newer);
    }
    return tools_.has_value() ? Result<messages::ToolTable>(*tools_)
                              : fail("the machine has no tool table yet");
}

bool Screens::join(Browser &browser) {
    auto client = setup_.connect();
    if (client.has_value()) {
        browser.join(std::move(*client));
    }
    return client.has_value();
}

void Screens::opened(SessionId session, const Rights &rights, std::int64_t now_ns) {
    auto made = std::make_unique<Browser>(
        [this, session](std::string text) { sockets_.send(session, std::move(text)); }, counts_, rights.role,
        now_ns);
    Browser &browser = *made;
    browsers_[session] = std::move(made);
    if (isMachineUp()) {
        browser.attach(*watch_);
        join(browser);
    }
    browser.tell(hello_text({setup_.version, role_name(rights.role), protection_name(rights.protection),
                             browser.number(), session_}));
    if (questions_ != "[]") {
        browser.tell(questions_text(questions_));
    }
    if (rights.role == Role::STATUS && !setup_.status_note.empty()) {
        browser.tell(note_text(setup_.status_note));
    }
    if (!browser.isAttached()) {
        browser.tell(machine_gone_text(reason_));
        return;
    }
    if (!browser.isJoined()) {
        browser.tell(note_text(Browser::ONLY_STOPS));
    }
    if (const messages::MachineStatus *now = status()) {
        browser.tell_status(*now);
    }
    for (const Kept &message : kept_) {
        browser.tell(aged(message.text, now_ns - message.at_ns));
    }
}

void Screens::received(SessionId session, std::string_view text, std::int64_t now_ns) {
    const auto found = browsers_.find(session);
    if (found == browsers_.end()) {
        return;
    }
    found->second->receive(text, now_ns);
    const auto &begun = found->second->begun();
    if (!begun.has_value()) {
        return;
    }
    for (const auto &[other, browser] : browsers_) {
        if (other != session) {
            browser->give_up(*begun);
        }
    }
}

void Screens::closed(SessionId session) {
    browsers_.erase(session);
}

void Screens::tick(std::int64_t now_ns) {
    now_ns_ = now_ns;
    if (now_ns >= next_look_ns_) {
        next_look_ns_ = now_ns + LOOK_NS;
        look_for_machine();
        for (const auto &[session, browser] : browsers_) {
            if (browser->isSilent(now_ns)) {
                sockets_.close(session);
            }
        }
    }
    if (!isMachineUp()) {
        return;
    }
    bool is_awaited = false;
    for (const auto &[session, browser] : browsers_) {
        browser->follow(now_ns);
        is_awaited = is_awaited || browser->isWaitingForStatus();
    }
    const bool is_due = now_ns >= next_status_ns_;
    if (!is_due && !is_awaited) {
        return;
    }
    next_status_ns_ = is_due ? now_ns + setup_.status_period_ns : next_status_ns_;
    pass_messages();
    tell_statuses(is_due);
    for (const auto &[session, browser] : browsers_) {
        browser->follow(now_ns);
    }
}

void Screens::look_for_machine() {
    if (watch_.has_value() && !watch_->isMachineAlive()) {
        lose_machine("the machine is no longer running");
    }
    if (!watch_.has_value()) {
        auto client = setup_.connect_for_all ? setup_.connect_for_all() : setup_.connect();
        if (!client.has_value()) {
            reason_ = client.error().str();
            return;
        }
        watch_.emplace(std::move(*client));
        watch_->rewind_messages(MOST_KEPT);  // also messages from before the start of this server
        log("the machine is running");
        has_status_ = false;
    }
    for (const auto &[session, browser] : browsers_) {
        const bool is_new = !browser->isAttached();
        if (is_new) {
            browser->attach(*watch_);
        }
        if ((!browser->isJoined() && join(*browser)) || is_new) {
            browser->tell(machine_up_text(browser->number()));
            browser->forget_status();
        }
    }
}

void Screens::log(const std::string &line, std::int64_t age_ns) const {
    if (log_) {
        log_(line, age_ns);
    }
}

void Screens::lose_machine(const std::string &reason) {
    reason_ = reason;
    log(reason);
    for (const auto &[session, browser] : browsers_) {
        if (browser->isAttached()) {
            browser->leave();
            browser->tell(machine_gone_text(reason));
        }
    }
    watch_.reset();
    has_status_ = false;
    tools_.reset();
    kept_.clear();  // another machine counts its messages from 1
}

void Screens::tell_all(const std::string &text) {
    for (const auto &[session, browser] : browsers_) {
        if (browser->isAttached()) {
            browser->tell(text);
        }
    }
}

std::vector<std::string> Screens::watched() const {
    std::set<std::string> names;
    for (const auto &[session, browser] : browsers_) {
        names.insert(browser->watched().begin(), browser->watched().end());
    }
    return {names.begin(), names.end()};
}

void Screens::tell_questions(const std::string &questions) {
    if (questions != questions_) {
        questions_ = questions;
        for (const auto &[session, browser] : browsers_) {
            browser->tell(questions_text(questions_));
        }
    }
}

void Screens::tell_note(const std::string &note) {
    log("NOTE: " + note);
    const std::string text = note_text(note);
    for (const auto &[session, browser] : browsers_) {
        browser->tell(text);
    }
    keep(text, now_ns_);
}

void Screens::keep(const std::string &text, std::int64_t at_ns) {
    kept_.push_back({text, at_ns});
    if (kept_.size() > MOST_KEPT) {
        kept_.pop_front();
    }
}

void Screens::tell_values(const std::map<std::string, std::string> &values) {
    for (const auto &[session, browser] : browsers_) {
        if (sockets_.isIdle(session)) {
            browser->tell_values(values);
        }
    }
}

void Screens::pass_messages() {
    while (const auto message = watch_->next_message()) {
        ++counts_.messages;
        const std::int64_t age_ns = std::max<std::int64_t>(0, now_ns_ - message->at_ns);
        if (log_ && watch_->claim_log(message->number)) {
            log(message_kind(*message) + ": " + std::string(message->text), age_ns);
        }
        const std::string text = message_text(*message, watch_->run());
        tell_all(aged(text, age_ns));
        keep(text, now_ns_ - age_ns);
    }
}

/// Reports that the server is alive but task is not: it is stopped, or hangs.
void Screens::tell_silence() {
    constexpr std::int64_t LONGEST_NS = 500000000, AGAIN_NS = 500000000;
    const std::uint64_t cycle = watch_->status().cycle;
    if (cycle != last_cycle_) {
        last_cycle_ = cycle;
        last_advance_ns_ = now_ns_;
        if (std::exchange(silence_told_ns_, 0) != 0) {
            tell_all(R"({"silent":0})");
        }
    } else if (now_ns_ - last_advance_ns_ > LONGEST_NS && now_ns_ - silence_told_ns_ >= AGAIN_NS) {
        silence_told_ns_ = now_ns_;
        tell_all(
            fmt::format(R"({{"silent":{:.1f}}})", static_cast<double>(now_ns_ - last_advance_ns_) / 1e9));
    }
}

/// `is_due`: sends to all screens; otherwise to those with a completed command.
void Screens::tell_statuses(bool is_due) {
    const bool is_read = watch_->read_status().has_value();
    has_status_ = has_status_ || is_read;
    if (has_status_) {
        tell_silence();
    }
    if (!is_read) {
        return;  // task has not begun, or has died, which the next check detects
    }
    const PartMask fresh = watch_->fresh_parts();
    for (const auto &[session, browser] : browsers_) {
        browser->note_read(fresh);
        // A slow screen receives the rest with its next status.
        if ((is_due || browser->isWaitingForStatus()) && browser->isAttached() && sockets_.isIdle(session)) {
            browser->tell_status(watch_->status());
        }
    }
}

}  // namespace mw::screen
