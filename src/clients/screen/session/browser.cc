// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/session/browser.hh"

#include <algorithm>

#include "base/overloaded.hh"
#include "clients/screen/http/error_response.hh"
#include "messages/mailbox/stops.hh"

namespace mw::screen {
namespace {

/// True if motion ends the jog when it is not renewed; false if jogs have no leases.
template <class Jog>
bool hasLease(const Jog &jog) {
    if constexpr (requires { jog.lease_ms; }) {
        return jog.lease_ms > 0;
    } else {
        return false;
    }
}

/// True if the jog would continue without limit when the browser freezes or the server is killed.
bool isEndless(const messages::Command &command) {
    const auto *jog = std::get_if<messages::JogContinuous>(&command);
    return jog != nullptr && !hasLease(*jog);
}

}  // namespace

const char *const Browser::ONLY_STOPS =
    "the machine has as many clients as it can have: this screen can only stop it until one leaves";

void Browser::leave() {
    for (const Followed &one : std::exchange(followed_, {})) {
        send_(outcome_text(one.id, {messages::Progress::FAILED, "the machine has ended"}));
    }
    client_.reset();
    shared_ = nullptr;
    jogs_.clear();
    has_whole_ = false;
}

void Browser::stop_jogs() {
    for (const auto &[isJoint, index] : std::exchange(jogs_, {})) {
        if (client_.has_value()) {
            static_cast<void>(client_->post(messages::JogStop{isJoint, index}));
        }
    }
}

void Browser::receive(std::string_view text, std::int64_t now_ns) {
    heard_ns_ = now_ns;
    begun_.reset();
    const auto read = read_text(text);
    if (!read.has_value()) {
        send_(error_response(400, read.error().str()).body);
        return;
    }
    std::visit(Overloaded{[this](const Ping &ping) { send_(pong_text(ping)); },
                          [this, now_ns](const Ask &ask) { carry_out(ask, now_ns); },
                          [this](const Watch &watch) {
                              if (role_ < Role::VIEW && !watch.names.empty()) {
                                  send_(error_response(403, "this needs a token of the role view").body);
                                  return;
                              }
                              watched_ = watch.names;
                              told_values_.clear();
                          }},
               *read);
}

void Browser::refuse(std::uint64_t id, std::string reason) {
    ++counts_.refused;
    send_(outcome_text(id, {messages::Progress::REFUSED, std::move(reason)}));
}

void Browser::carry_out(const Ask &ask, std::int64_t now_ns) {
    if (!ask.command.has_value()) {
        refuse(ask.id, ask.command.error().str());
        return;
    }
    messages::Command command = *ask.command;
    const bool isStop = mailbox::isStop(command);
    ++(isStop ? counts_.stops : counts_.commands);
    client::Client *const shared = client_.has_value() ? nullptr : shared_;
    if (!client_.has_value() && (shared == nullptr || !isStop)) {
        refuse(ask.id, shared == nullptr ? "no machine is running" : ONLY_STOPS);
        return;
    }
    if (!isStop && role_ < Role::OPERATE) {
        refuse(ask.id, "who came in with this token may look, and stop, but not operate");
        return;
    }
    if (isEndless(command)) {
        refuse(ask.id,
               "a continuous jog from a screen needs a lease, lease_ms, so that it ends when the screen "
               "is gone; jog by increments without one");
        return;
    }
    const bool followed = followed_.size() < MOST_FOLLOWED;
    if (!isStop && !followed) {
        refuse(ask.id, "as many commands as can be are under way");
        return;
    }
    if (!isStop && !rate_.take(now_ns)) {
        refuse(ask.id, "too many commands in a second");
        return;
    }
    if (!shorten_lease(command, ask, now_ns)) {
        refuse(ask.id, "it came later than its lease is long: the way from the screen is slow");
        return;
    }
    const auto posted = shared != nullptr ? shared->post(command) : client_->post(command);
    if (!posted.has_value()) {
        refuse(ask.id, posted.error().str());
        return;
    }
    note_jog(command);
    if (!followed) {  // not the oldest command, because the user waits for long commands
        send_(outcome_text(ask.id, {messages::Progress::FAILED,
                                    "the command was sent; too many others are active to follow it"}));
        return;
    }
    followed_.push_back({ask.id, shared, *posted, now_ns, isStop});
}

bool Browser::shorten_lease(messages::Command &command, const Ask &ask, std::int64_t now_ns) {
    const double late_ms = ask.sent_ms.has_value() ? lateness_.of(*ask.sent_ms, now_ns) : 0;
    auto *const jog = std::get_if<messages::JogContinuous>(&command);
    if (jog == nullptr || !hasLease(*jog)) {
        return true;
    }
    const double left_ms = jog->lease_ms - late_ms;
    jog->lease_ms = static_cast<int>(left_ms);
    return left_ms >= messages::SHORTEST_JOG_LEASE_MS;
}

void Browser::note_jog(const messages::Command &command) {
    const auto begin = [this](bool isJoint, int index) { begun_ = *jogs_.emplace(isJoint, index).first; };
    if (const auto *jog = std::get_if<messages::JogContinuous>(&command)) {
        begin(jog->isJoint, jog->index);
    } else if (const auto *step = std::get_if<messages::JogIncrement>(&command)) {
        begin(step->isJoint, step->index);
    } else if (const auto *way = std::get_if<messages::JogAbsolute>(&command)) {
        begin(way->isJoint, way->index);
    } else if (const auto *stop = std::get_if<messages::JogStop>(&command)) {
        jogs_.erase({stop->isJoint, stop->index});
    }
}

bool Browser::isEffectShown(const Followed &one, std::int64_t now_ns) const {
    return one.isStop || !isAttached() || !has_whole_ || one.isShown ||
           now_ns - one.done_ns >= LONGEST_WAIT_NS;
}

bool Browser::isWaitingForStatus() const {
    return std::ranges::any_of(followed_, [](const Followed &one) { return one.done_ns != 0; });
}

/// Decides whether a written status shows the effect of a command that was seen as DONE.
void Browser::note_shown(std::uint64_t cycle) {
    for (Followed &one : followed_) {
        if (one.done_ns != 0) {
            one.isShown = one.isShown || (one.done_cycle.has_value() && cycle > *one.done_cycle);
            one.done_cycle = one.done_cycle.value_or(cycle);
        }
    }
}

void Browser::follow(std::int64_t now_ns) {
    if (!client_.has_value() && shared_ == nullptr) {
        return;
    }
    std::erase_if(followed_, [this, now_ns](Followed &one) {
        const client::Outcome outcome =
            one.client != nullptr ? one.client->outcome(one.serial) : client_->outcome(one.serial);
        const bool is_done = outcome.progress == messages::Progress::DONE;
        one.done_ns = is_done && one.done_ns == 0 ? now_ns : one.done_ns;
        if (is_done && !isEffectShown(one, now_ns)) {
            return false;
        }
        const bool over = outcome.progress != messages::Progress::STARTED;
        const bool to_be_told = over || (!one.isTold && now_ns - one.since_ns >= SOON_NS);
        if (to_be_told) {
            one.isTold = true;
            counts_.refused += outcome.progress == messages::Progress::REFUSED ? 1 : 0;
            send_(outcome_text(one.id, outcome));
        }
        return over;
    });
}

void Browser::tell_status(const messages::MachineStatus &status) {
    note_shown(status.cycle);
    if (!has_whole_) {
        has_whole_ = true;
        unread_ = 0;
        ++counts_.statuses;
        send_(status_text(delta_.whole(status), true));
        return;
    }
    const PartMask parts = std::exchange(unread_, 0);
    const std::string changes = parts == 0 ? "" : delta_.next(status, parts);
    if (!changes.empty()) {
        ++counts_.statuses;
        send_(status_text(changes, false));
    }
}

void Browser::tell_values(const std::map<std::string, std::string> &values) {
    std::map<std::string, std::string> changed;
    for (const std::string &name : watched_) {
        const auto found = values.find(name);
        if (found == values.end()) {
            continue;  // watched after the values were read
        }
        std::string &told = told_values_[name];
        if (told != found->second) {
            changed[name] = told = found->second;
        }
    }
    if (!changed.empty()) {
        send_(values_text(changed));
    }
}

}  // namespace mw::screen
