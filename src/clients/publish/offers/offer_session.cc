// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/offers/offer_session.hh"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.hh"

namespace mw::publish {

OfferSession::OfferSession(OfferSettings settings, offers::OfferBox &box, BrokerLink &link, Tell tell)
    : settings_(std::move(settings)), box_(box), copies_(settings_.copies), link_(link),
      tell_(std::move(tell)), retry_s_(settings_.first_retry_s) {}

void OfferSession::tell_trouble(const Result<> &done) {
    const std::string now = done.has_value() ? "" : done.error().str();
    if (now != std::exchange(trouble_, now) && !now.empty()) {
        tell_(fmt::format("Offers of the shop: {}.", now));
    }
}

void OfferSession::connect() {
    phase_ = Phase::CONNECTING;
    phase_end_s_ = now_.at_s + settings_.answer_s;
    link_.connect(broker_, {});
}

void OfferSession::lose() {
    phase_ = Phase::WAITING;
    phase_end_s_ = now_.at_s + retry_s_;
    retry_s_ = std::min(2 * retry_s_, settings_.longest_retry_s);
    broker_ = (broker_ + 1) % std::max<std::size_t>(settings_.brokers, 1);
}

void OfferSession::take(const LinkEvent &event) {
    std::visit(Overloaded{[this](const Connected &) {
                              link_.subscribe(offers::reply_topic(settings_.host, settings_.group,
                                                                  settings_.node, settings_.device));
                              phase_ = Phase::ONLINE;
                              retry_s_ = settings_.first_retry_s;
                              reply_s_ = now_.at_s;
                              report_s_ = now_.at_s;
                          },
                          [this](const Disconnected &) { lose(); },
                          [this](const Publication &message) {
                              if (phase_ == Phase::ONLINE && !message.isRetained) {
                                  take_reply(message.payload);
                              }
                          },
                          [](const BarrierPassed &) {}},
               event);
}

void OfferSession::take_reply(std::string_view payload) {
    const auto reply = offers::decode_reply(payload);
    if (!reply.has_value()) {
        tell_trouble(fail(fmt::format("a message is rejected: {}", reply.error().message)));
        return;
    }
    reply_s_ = now_.at_s;
    for (const std::string &kind : reply->wanted) {
        if (const offers::Copy *const copy = copies_.find(kind); copy != nullptr) {
            link_.publish(
                {offers::copy_topic(settings_.host, settings_.group, settings_.node, settings_.device),
                 offers::encode(*copy), 1, false});
        }
    }
    Result<> done;
    if (!reply->noted.empty()) {
        done = box_.note(reply->noted);
    }
    if (done.has_value() && !reply->withdrawn.empty()) {
        done = box_.withdraw(reply->withdrawn, now_.utc_ms);
    }
    tell_trouble(done);
    if (done.has_value()) {
        take_offer(*reply);
    }
}

void OfferSession::take_offer(const offers::Reply &reply) {
    if (reply.broken.has_value()) {
        tell_(fmt::format("An offer of the shop is rejected: {}.", reply.broken->why));
        tell_trouble(box_.reject(*reply.broken, now_.utc_ms));
    } else if (reply.offer.has_value()) {
        tell_trouble(box_.take(*reply.offer, now_.utc_ms));
    }
}

void OfferSession::report() {
    report_s_ = now_.at_s + settings_.report_s;
    const std::uint64_t version = box_.version();
    const auto entries = box_.entries();
    if (!entries.has_value()) {
        tell_trouble(std::unexpected(entries.error()));
        return;
    }
    version_ = version;
    offers::Report report = offers::report_of(*entries);
    report.copies = copies_.look(now_.at_s);
    link_.publish({offers::report_topic(settings_.host, settings_.group, settings_.node, settings_.device),
                   offers::encode(report), 1, false});
}

void OfferSession::step(const Moment &now) {
    now_ = now;
    while (const auto event = link_.next_event()) {
        take(*event);
    }
    const bool isOver = now_.at_s >= phase_end_s_;
    if (phase_ == Phase::WAITING && isOver) {
        connect();
    } else if (phase_ == Phase::CONNECTING && isOver) {
        link_.drop();
        lose();
    } else if (phase_ == Phase::ONLINE && settings_.brokers > 1 &&
               now_.at_s - reply_s_ > settings_.silence_s) {
        link_.disconnect();
        lose();
    } else if (phase_ == Phase::ONLINE && (now_.at_s >= report_s_ || box_.version() != version_)) {
        report();
    }
}

void OfferSession::end() {
    phase_ == Phase::ONLINE ? link_.disconnect() : link_.drop();
    phase_ = Phase::WAITING;
}

}  // namespace mw::publish
