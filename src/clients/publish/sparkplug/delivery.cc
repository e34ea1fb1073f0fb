// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/delivery.hh"

namespace mw::publish {

void Delivery::begin(RecordId confirmed, bool hasReceipts) {
    history_ = history_end_ = live_ = barred_ = confirmed;
    unbarred_ = 0;
    barrier_.reset();
    // Records sent shortly before the broker was lost are sent again, because subscribers may not have
    // received them.
    passed_.clear();
    hasReceipts_ = hasReceipts;
    sent_ = received_ = 0;
    marks_.clear();
}

void Delivery::step_sent(double now_s) {
    if (hasReceipts_ && sent_ > (marks_.empty() ? received_ : marks_.back().sent)) {
        marks_.push_back({sent_, sent_end(), now_s});
    }
}

void Delivery::received(std::uint64_t count) {
    received_ = std::clamp(count, received_, sent_);
}

void Delivery::birth(RecordId next) {
    history_ = sent_end();
    history_end_ = live_ = next;
}

bool Delivery::isBarrierDue(double now_s) const {
    if (hasReceipts_) {
        return false;
    }
    const bool isNeeded = sent_end() > barred_ || isHalfFull();
    const bool isTime = now_s - barrier_at_s_ >= settings_.barrier_s || isHalfFull();
    return !barrier_.has_value() && unbarred_ > 0 && isNeeded && isTime;
}

void Delivery::barrier_sent(int number, double now_s) {
    barred_ = sent_end();
    barrier_at_s_ = now_s;
    barrier_ = Barrier{number, barred_, now_s};
    unbarred_ = 0;
}

void Delivery::barrier_passed(int number) {
    if (barrier_.has_value() && barrier_->number == number) {
        passed_.push_back(*barrier_);
        barrier_.reset();
    }
}

std::optional<double> Delivery::waiting_since() const {
    if (hasReceipts_) {
        return marks_.empty() ? std::nullopt : std::optional(marks_.front().at_s);
    }
    return barrier_.has_value() ? std::optional(barrier_->at_s) : std::nullopt;
}

std::optional<RecordId> Delivery::confirmed(double now_s) {
    std::optional<RecordId> end;
    while (!marks_.empty() && marks_.front().sent <= received_) {
        end = marks_.front().end;
        marks_.pop_front();
    }
    while (!passed_.empty() && passed_.front().at_s + settings_.hold_back_s <= now_s) {
        end = passed_.front().end;
        passed_.pop_front();
    }
    return end;
}

}  // namespace mw::publish
