// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/mtconnect/observations.hh"

#include <algorithm>
#include <utility>

namespace mw::publish::mtconnect {

Observations::Observations(std::size_t items, std::size_t capacity, TimeMs at)
    : capacity_(std::max(capacity, items + 1)), newest_(items) {
    for (ItemId i = 0; i < items; ++i) {
        ring_.push_back({i + 1, i, at, UNAVAILABLE});
        newest_[i] = ring_.back();
    }
    before_ = newest_;
}

void Observations::add(ItemId item, std::string value, TimeMs at) {
    ring_.push_back({next(), item, at, std::move(value)});
    newest_[item] = ring_.back();
    if (ring_.size() > capacity_) {
        before_[ring_.front().item] = ring_.front();
        ring_.pop_front();
    }
}

std::vector<Observation> Observations::at(Sequence sequence) const {
    std::vector<Observation> state = before_;
    for (const Observation &one : ring_) {
        if (one.sequence > sequence) {
            break;
        }
        state[one.item] = one;
    }
    return state;
}

}  // namespace mw::publish::mtconnect
