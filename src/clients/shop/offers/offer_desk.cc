// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/offers/offer_desk.hh"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.hh"

namespace mw::shop {

OfferDesk::OfferDesk(DeskSettings settings, publish::BrokerLink &link, OfferLedger &ledger, Tell tell)
    : settings_(std::move(settings)), link_(link), ledger_(ledger), tell_(std::move(tell)) {}

void OfferDesk::tell_trouble(const std::string &what) {
    if (what != std::exchange(trouble_, what) && !what.empty()) {
        tell_(what);
    }
}

void OfferDesk::lose() {
    phase_ = Phase::WAITING;
    phase_end_s_ = now_s_ + settings_.retry_s;
    broker_ = (broker_ + 1) % std::max<std::size_t>(settings_.brokers, 1);
    sent_.clear();
}

void OfferDesk::take(const publish::LinkEvent &event) {
    std::visit(Overloaded{[this](const publish::Connected &) {
                              phase_ = Phase::ONLINE;
                              if (settings_.groups.empty()) {
                                  subscribe("+");
                              }
                              for (const std::string &group : settings_.groups) {
                                  subscribe(group);
                              }
                          },
                          [this](const publish::Disconnected &) { lose(); },
                          [this](const publish::Publication &message) {
                              if (phase_ != Phase::ONLINE || message.isRetained) {
                                  return;
                              }
                              if (const auto machine = machine_of("report", message.topic)) {
                                  take_report(*machine, message);
                              } else if (const auto sender = machine_of("copy", message.topic)) {
                                  take_copy(*sender, message);
                              }
                          },
                          [](const publish::BarrierPassed &) {}},
               event);
}

void OfferDesk::subscribe(const std::string &group) {
    link_.subscribe(offers::report_topic(settings_.name, group, "+", "+"));
    link_.subscribe(offers::copy_topic(settings_.name, group, "+", "+"));
}

std::optional<MachineName> OfferDesk::machine_of(std::string_view kind, std::string_view topic) const {
    const std::string start = fmt::format("millwright/{}/{}/", kind, settings_.name);
    if (!topic.starts_with(start)) {
        return std::nullopt;
    }
    topic.remove_prefix(start.size());
    const std::size_t first = topic.find('/');
    const std::size_t second = first == std::string_view::npos ? first : topic.find('/', first + 1);
    if (second == std::string_view::npos || topic.find('/', second + 1) != std::string_view::npos) {
        return std::nullopt;
    }
    return MachineName{
        {std::string(topic.substr(0, first)), std::string(topic.substr(first + 1, second - first - 1))},
        std::string(topic.substr(second + 1))};
}

/// A machine that has not received an offer completely reports again meanwhile. It is not sent again at once,
/// because it may be large.
void OfferDesk::hold_back(const MachineName &machine, offers::Reply &reply) {
    if (!reply.offer.has_value()) {
        return;
    }
    Sent &last = sent_[machine];
    if (last.id == reply.offer->id && now_s_ - last.at_s < settings_.resend_s) {
        reply.offer.reset();
    } else {
        last = {reply.offer->id, now_s_};
    }
}

void OfferDesk::take_copy(const MachineName &machine, const publish::Publication &message) {
    const auto copy = offers::decode_copy(message.payload);
    const auto done =
        copy.has_value() ? ledger_.take(machine, *copy) : Result<>(std::unexpected(copy.error()));
    if (!done.has_value()) {
        tell_trouble(fmt::format("{}: {}.", message.topic, done.error().message));
    }
}

void OfferDesk::take_report(const MachineName &machine, const publish::Publication &message) {
    const auto report = offers::decode_report(message.payload);
    if (!report.has_value()) {
        tell_trouble(fmt::format("{}: {}.", message.topic, report.error().message));
        return;
    }
    auto reply = ledger_.take(machine, *report);
    if (!reply.has_value()) {
        tell_trouble(
            fmt::format("Offers wait in the database and at the machines: {}.", reply.error().message));
        return;
    }
    tell_trouble("");
    hold_back(machine, *reply);
    link_.publish({offers::reply_topic(settings_.name, machine.node.group, machine.node.node, machine.device),
                   offers::encode(*reply), 1, false});
}

void OfferDesk::step(double now_s) {
    now_s_ = now_s;
    while (const auto event = link_.next_event()) {
        take(*event);
    }
    const bool isOver = now_s_ >= phase_end_s_;
    if (phase_ == Phase::WAITING && isOver) {
        phase_ = Phase::CONNECTING;
        phase_end_s_ = now_s_ + settings_.answer_s;
        link_.connect(broker_, {});
    } else if (phase_ == Phase::CONNECTING && isOver) {
        link_.drop();
        lose();
    }
}

void OfferDesk::end() {
    phase_ == Phase::ONLINE ? link_.disconnect() : link_.drop();
    phase_ = Phase::WAITING;
}

}  // namespace mw::shop
