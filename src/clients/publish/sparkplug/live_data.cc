// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/live_data.hh"

#include <algorithm>

#include "clients/publish/sparkplug/payload.hh"

namespace mw::publish {

LiveData::LiveData(DataLog log) : log_(std::move(log)) {
    const auto payload = decode_payload(log_.newest());
    last_ = payload.has_value() ? payload->at.value_or(0) : 0;
    picture_.next = log_.next_id();
}

TimeMs LiveData::next_time(TimeMs now) {
    last_ = std::max(last_ + 1, now);
    return last_;
}

void LiveData::append(const std::vector<Change> &changes, TimeMs at) {
    Payload payload{.at = at};
    for (const Change &change : changes) {
        const Definition &definition = picture_.definitions[change.metric];
        payload.metrics.push_back({.name = definition.name, .type = definition.type, .value = change.value});
        picture_.values[change.metric] = change.value;
        picture_.times[change.metric] = at;
    }
    log_.append(encode(payload));
    picture_.next = log_.next_id();
}

void LiveData::born(const std::vector<Metric> &metrics, std::vector<Value> values, TimeMs now) {
    const std::lock_guard lock(mutex_);
    const TimeMs at = next_time(now);
    picture_.isAlive = true;
    ++picture_.generation;
    picture_.definitions.clear();
    std::vector<Change> all;
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        picture_.definitions.push_back({metrics[i].name, metrics[i].type, metrics[i].unit});
        all.push_back({i, std::move(values[i])});
    }
    picture_.values.assign(metrics.size(), Value());
    picture_.times.assign(metrics.size(), at);
    append(all, at);
}

void LiveData::add(const std::vector<Change> &changes, TimeMs now) {
    const std::lock_guard lock(mutex_);
    if (!changes.empty() && picture_.isAlive) {
        append(changes, next_time(now));
    }
}

void LiveData::gone() {
    const std::lock_guard lock(mutex_);
    picture_.isAlive = false;
}

TimeMs LiveData::ahead_ms(TimeMs now) const {
    const std::lock_guard lock(mutex_);
    return last_ - std::min(last_, now);
}

std::string LiveData::sync() {
    const std::lock_guard lock(mutex_);
    log_.sync();
    return log_.trouble();
}

Picture LiveData::picture() const {
    const std::lock_guard lock(mutex_);
    return picture_;
}

LiveData::State LiveData::state() const {
    const std::lock_guard lock(mutex_);
    return {picture_.isAlive, picture_.generation, picture_.next, log_.confirmed(), log_.dropped()};
}

std::vector<Record> LiveData::read(RecordId from, std::size_t most) const {
    const std::lock_guard lock(mutex_);
    return log_.read(from, most);
}

void LiveData::confirm(RecordId end) {
    const std::lock_guard lock(mutex_);
    log_.confirm(end);
}

}  // namespace mw::publish
