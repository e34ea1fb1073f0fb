// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/assembly/collector.hh"

#include <algorithm>
#include <utility>

#include "base/overloaded.hh"

namespace mw::shop {

Collector::Collector(CollectorSettings settings, HostSettings host, publish::BrokerLink &link,
                     StoreThread &store, Report report)
    : settings_(settings), link_(link), store_(store), report_(std::move(report)),
      host_(std::move(host), link, report_) {}

bool Collector::isStoreWorking() {
    const StoreThread::State state = store_.state();
    if (state == StoreThread::State::IDLE) {
        return true;
    }
    return state == StoreThread::State::BUSY && now_.at_s - batch_s_ < settings_.store_s;
}

void Collector::take(const publish::LinkEvent &event) {
    std::visit(Overloaded{[this](const publish::Connected &) {
                              if (std::exchange(hasReported_, false)) {
                                  report_("Connected to the broker.");
                              }
                              phase_ = Phase::ONLINE;
                              host_.connected();
                          },
                          [this](const publish::Disconnected &what) { lose(what.reason); },
                          [this](const publish::Publication &message) {
                              if (phase_ == Phase::ONLINE) {
                                  host_.take(message, now_);
                              }
                          },
                          [](const publish::BarrierPassed &) {}},
               event);
}

void Collector::lose(const std::string &why) {
    if (!std::exchange(hasReported_, true)) {
        report_(why);
    }
    host_.forget();
    phase_ = Phase::WAITING;
    phase_end_s_ = now_.at_s + settings_.retry_s;
    broker_ = (broker_ + 1) % std::max<std::size_t>(settings_.brokers, 1);
}

void Collector::leave(const std::string &why) {
    host_.say_offline();
    link_.disconnect();
    host_.forget();
    report_(why);
    phase_ = Phase::WAITING;
    phase_end_s_ = now_.at_s;
}

void Collector::end() {
    if (phase_ == Phase::ONLINE) {
        host_.say_offline();
        link_.disconnect();
    } else {
        link_.drop();
    }
    host_.forget();
    phase_ = Phase::WAITING;
}

void Collector::give_batch() {
    const bool isDue = now_.at_s - batch_s_ >= settings_.batch_s;
    if (isDue && host_.hasBatch() && store_.state() == StoreThread::State::IDLE) {
        batch_s_ = now_.at_s;
        Batch batch = host_.take_batch();
        if (watch_) {
            watch_(batch);
        }
        store_.give(std::move(batch));
    }
}

void Collector::step(const Moment &now) {
    now_ = now;
    while (const auto event = link_.next_event()) {
        take(*event);
    }
    const bool isOver = now_.at_s >= phase_end_s_;
    switch (phase_) {
    case Phase::WAITING:
        if (isOver && store_.state() == StoreThread::State::IDLE) {
            opened_ = store_.opened();
            static_cast<void>(store_.take_stored());
            phase_ = Phase::CONNECTING;
            phase_end_s_ = now_.at_s + settings_.answer_s;
            link_.connect(broker_, host_.will(now_));
        }
        return;
    case Phase::CONNECTING:
        if (isOver) {
            link_.drop();
            lose("The broker does not answer.");
        }
        return;
    case Phase::ONLINE: break;
    }
    if (const auto stored = store_.take_stored(); stored.has_value() && store_.opened() == opened_) {
        host_.stored(*stored);
    }
    if (store_.opened() != opened_ || !isStoreWorking()) {
        leave("The database does not answer. The machines store their values.");
        return;
    }
    if (host_.waiting() > settings_.most_readings) {
        leave("The database is too slow. The machines store their values.");
        return;
    }
    give_batch();
    host_.step(now_);
}

}  // namespace mw::shop
