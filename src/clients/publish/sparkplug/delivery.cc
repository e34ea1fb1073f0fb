// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/delivery.hh"

namespace mw::publish {

void Delivery::begin(RecordId confirmed) {
    history_ = history_end_ = live_ = barred_ = confirmed;
    unbarred_ = 0;
    barrier_.reset();
    // What the broker had shortly before it was lost is sent again: subscribers may not have it.
    passed_.clear();
}

void Delivery::birth(RecordId next) {
    history_ = sent_end();
    history_end_ = live_ = next;
}

bool Delivery::isBarrierDue(double now_s) const {
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
    return barrier_.has_value() ? std::optional(barrier_->at_s) : std::nullopt;
}

std::optional<RecordId> Delivery::confirmed(double now_s) {
    std::optional<RecordId> end;
    while (!passed_.empty() && passed_.front().at_s + settings_.hold_back_s <= now_s) {
        end = passed_.front().end;
        passed_.pop_front();
    }
    return end;
}

}  // namespace mw::publish
