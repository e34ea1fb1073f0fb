// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/host/host_application.hh"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "clients/publish/sparkplug/host_state.hh"

namespace mw::shop {
namespace {

constexpr std::string_view NAMESPACE = "spBv1.0/";
constexpr const char *REBIRTH = "Node Control/Rebirth";
/// True for metrics of the protocol, which do not belong to a machine.
bool isOfProtocol(std::string_view metric) {
    return metric == "bdSeq" || metric.starts_with("Node Control/") || metric.starts_with("Device Control/");
}
/// Interval between two passes over the due receipts, because a step is executed for each message.
constexpr double RECEIPT_PERIOD_S = 0.05;
/// The series of such a metric.
constexpr SeriesId NOT_STORED = ~SeriesId{0};
/// 31 December 9999; later times are not stored.
constexpr TimeMs LAST_TIME = 253'402'214'400'000;

template <class Narrow>
Value sign_extended(std::uint64_t bits) {
    return static_cast<std::int64_t>(static_cast<Narrow>(bits));
}

std::uint64_t bdseq_of(const publish::Payload &payload) {
    for (const publish::PayloadMetric &metric : payload.metrics) {
        if (metric.name == "bdSeq") {
            const Value value = typed(metric.value, static_cast<std::uint32_t>(publish::DataType::UINT64));
            const auto *const number = std::get_if<std::uint64_t>(&value);
            const auto *const other = std::get_if<std::int64_t>(&metric.value);
            return number != nullptr ? *number : other != nullptr ? static_cast<std::uint64_t>(*other) : 0;
        }
    }
    return 0;
}

}  // namespace

Value typed(const Value &value, std::uint32_t type) {
    const auto *const bits = std::get_if<std::uint64_t>(&value);
    if (bits == nullptr) {
        return value;
    }
    constexpr std::uint32_t INT8 = 1, INT16 = 2, INT32 = 3, INT64 = 4;
    switch (type) {
    case INT8: return sign_extended<std::int8_t>(*bits);
    case INT16: return sign_extended<std::int16_t>(*bits);
    case INT32: return sign_extended<std::int32_t>(*bits);
    case INT64: return std::bit_cast<std::int64_t>(*bits);
    default: return value;
    }
}

HostApplication::HostApplication(HostSettings settings, publish::BrokerLink &link, Report report)
    : settings_(std::move(settings)), link_(link), report_(std::move(report)),
      state_topic_(fmt::format("{}STATE/{}", NAMESPACE, settings_.name)) {}

std::optional<HostApplication::Topic> HostApplication::split(std::string_view topic) {
    if (!topic.starts_with(NAMESPACE)) {
        return std::nullopt;
    }
    topic.remove_prefix(NAMESPACE.size());
    std::vector<std::string> parts;
    while (true) {
        const std::size_t end = topic.find('/');
        parts.emplace_back(topic.substr(0, end));
        if (end == std::string_view::npos) {
            break;
        }
        topic.remove_prefix(end + 1);
    }
    constexpr std::size_t OF_NODE = 3, OF_DEVICE = 4;
    if (parts.size() != OF_NODE && parts.size() != OF_DEVICE) {
        return std::nullopt;
    }
    Topic split{{parts[0], parts[2]}, parts[1], parts.size() == OF_DEVICE ? parts[3] : ""};
    const bool isOfDevice = split.type.starts_with('D');
    return isOfDevice == !split.device.empty() ? std::optional(std::move(split)) : std::nullopt;
}

publish::Publication HostApplication::will(const Moment &now) {
    state_at_ = std::max(now.utc_ms, state_at_ + 1);
    return {state_topic_, publish::write_host_state({false, state_at_, true}), 1, true};
}

void HostApplication::publish_state(bool isOnline) {
    link_.publish({state_topic_, publish::write_host_state({isOnline, state_at_, true}), 1, true});
}

void HostApplication::connected() {
    forget();
    isOnline_ = true;
    // Subscribes first, because a node that sees the state sends its birth at once.
    link_.subscribe(state_topic_);
    if (settings_.groups.empty()) {
        link_.subscribe(fmt::format("{}+/+/#", NAMESPACE));
    }
    for (const std::string &group : settings_.groups) {
        link_.subscribe(fmt::format("{}{}/#", NAMESPACE, group));
    }
    publish_state(true);
}

void HostApplication::say_offline() {
    isOnline_ = false;
    publish_state(false);
}

void HostApplication::forget() {
    isOnline_ = false;
    isCounted_ = false;
    census_s_.reset();
    batch_.census.reset();
    nodes_.clear();
    awaited_.clear();
    unstored_.clear();
    receipts_.clear();
    batch_.readings.clear();
    batch_.presences.clear();
    batch_.receipts.clear();
}

void HostApplication::take(const publish::Publication &message, const Moment &now) {
    now_ = now;
    if (message.topic == state_topic_) {
        // The will of an earlier connection of this host may arrive after its state.
        const auto state = publish::read_host_state(message.payload);
        if (isOnline_ && state.has_value() && !state->isOnline) {
            publish_state(true);
        }
        return;
    }
    const auto topic = split(message.topic);
    const bool isRead = topic.has_value() && topic->node.group != "STATE" && topic->type != "NCMD" &&
                        topic->type != "DCMD" && !message.isRetained;
    if (!isRead) {
        return;
    }
    Node &node = nodes_[topic->node];
    const auto payload = publish::decode_payload(message.payload);
    if (!payload.has_value()) {
        if (!std::exchange(node.hasReported, true)) {
            report_(fmt::format("{} is not a payload of Sparkplug B. It is not stored.", message.topic));
        }
        return;
    }
    if (topic->type == "NBIRTH") {
        take_birth_of_node(node, *topic, *payload);
    } else if (topic->type == "NDEATH") {
        take_death_of_node(node, *topic, *payload);
        return;
    } else if (!follow_sequence(node, *payload)) {
        request_birth(node, topic->node);
        if (payload->position.has_value()) {
            return;
        }
    }
    Device &device = node.devices[topic->device];
    const MachineName name{topic->node, topic->device};
    const TimeMs at = std::min(payload->at.value_or(now.utc_ms), LAST_TIME);
    node.clock_ahead_ms = static_cast<std::int64_t>(at) - static_cast<std::int64_t>(now.utc_ms);
    if (topic->type == "DBIRTH" || topic->type == "NBIRTH") {
        define(device, *topic, *payload);
        set_alive(node, name, true, at);
    } else if (topic->type == "DDEATH") {
        set_alive(node, name, false, at);
    }
    add_readings(node, *topic, *payload);
    if (node.isInOrder && node.isCounted) {
        ++node.position.count;
        unstored_.insert(topic->node);
    }
}

void HostApplication::take_birth_of_node(Node &node, const Topic &topic, const publish::Payload &payload) {
    for (auto &[device, facts] : node.devices) {
        facts.by_alias.clear();
        facts.by_name.clear();
        facts.isAwaited = facts.isAlive && !device.empty();
    }
    awaited_[topic.node] = now_.at_s + settings_.devices_s;
    node.isInOrder = true;
    node.isCounted =
        payload.position.has_value() && payload.position == publish::Position{payload.at.value_or(0), 1};
    node.seq = static_cast<std::uint8_t>(payload.seq.value_or(0) + 1);
    node.position = {bdseq_of(payload), payload.at.value_or(0), 0};
    receipts_.erase(topic.node);
}

void HostApplication::take_death_of_node(Node &node, const Topic &topic, const publish::Payload &payload) {
    // The will of an earlier connection may arrive after the birth of the next one.
    if (node.position.birth == 0 || bdseq_of(payload) != node.position.bdseq) {
        return;
    }
    for (auto &[device, facts] : node.devices) {
        // The will has the time of its connection.
        set_alive(node, {topic.node, device}, false, now_of(node));
    }
    awaited_.erase(topic.node);
    node.isInOrder = false;
    node.position = {};
}

/// False if a message is missing.
bool HostApplication::follow_sequence(Node &node, const publish::Payload &payload) {
    const bool isNext = !node.isCounted ||
                        payload.position == publish::Position{node.position.birth, node.position.count + 1};
    node.isInOrder = node.isInOrder && payload.seq == node.seq && isNext;
    ++node.seq;
    return node.isInOrder;
}

void HostApplication::request_birth(Node &node, const NodeName &name) {
    if (now_.at_s - node.requested_s < settings_.rebirth_s) {
        return;
    }
    node.requested_s = now_.at_s;
    publish::Payload payload{.at = now_.utc_ms};
    payload.metrics.push_back(
        {.name = REBIRTH, .at = now_.utc_ms, .type = publish::DataType::BOOLEAN, .value = true});
    link_.publish({fmt::format("{}{}/NCMD/{}", NAMESPACE, name.group, name.node), encode(payload), 0, false});
}

SeriesId HostApplication::series_of(const MachineName &machine, const publish::PayloadMetric &metric) {
    const std::string name = publish::clean_text(metric.name);
    const auto [at, isNew] = series_.try_emplace({machine, name}, static_cast<SeriesId>(series_.size()));
    if (isNew) {
        batch_.new_series.push_back({machine, name, publish::clean_text(metric.unit)});
    }
    return at->second;
}

void HostApplication::define(Device &device, const Topic &topic, const publish::Payload &payload) {
    device.by_alias.clear();
    device.by_name.clear();
    for (const publish::PayloadMetric &metric : payload.metrics) {
        if (metric.name.empty()) {
            continue;
        }
        const Metric known{isOfProtocol(metric.name) ? NOT_STORED
                                                     : series_of({topic.node, topic.device}, metric),
                           metric.type_number};
        device.by_name[metric.name] = known;
        if (metric.alias.has_value()) {
            device.by_alias[*metric.alias] = known;
        }
    }
}

/// Null if the birth of the device is missing.
const HostApplication::Metric *HostApplication::find(const Device &device,
                                                     const publish::PayloadMetric &metric) {
    if (!metric.name.empty()) {
        const auto found = device.by_name.find(metric.name);
        return found != device.by_name.end() ? &found->second : nullptr;
    }
    const auto found = device.by_alias.find(metric.alias.value_or(0));
    return found != device.by_alias.end() ? &found->second : nullptr;
}

void HostApplication::add_readings(Node &node, const Topic &topic, const publish::Payload &payload) {
    const Device &device = node.devices[topic.device];
    for (const publish::PayloadMetric &metric : payload.metrics) {
        const Metric *const known = find(device, metric);
        const TimeMs at = metric.at.value_or(payload.at.value_or(0));
        if (known == nullptr) {
            node.isInOrder = false;
            request_birth(node, topic.node);
        } else if (at == 0 || at > LAST_TIME) {
            if (!std::exchange(node.hasReported, true)) {
                report_(fmt::format("A value of {}/{} has no valid time. It is not stored.", topic.node.group,
                                    topic.node.node));
            }
        } else if (known->series != NOT_STORED) {
            const TimeMs sent = payload.at.value_or(at);
            batch_.readings.push_back(
                {known->series, at, typed(metric.value, known->type), sent - std::min(at, sent)});
        }
    }
}

TimeMs HostApplication::now_of(const Node &node) const {
    return static_cast<TimeMs>(
        std::max<std::int64_t>(static_cast<std::int64_t>(now_.utc_ms) + node.clock_ahead_ms, 0));
}

void HostApplication::set_alive(Node &node, const MachineName &name, bool isAlive, TimeMs at) {
    Device &device = node.devices[name.device];
    if (device.isAlive != isAlive || isAlive) {
        device.presence_at = std::max(at, device.presence_at + 1);
        batch_.presences.push_back({name, device.presence_at, isAlive, node.clock_ahead_ms});
    }
    device.isAlive = isAlive;
    device.isAwaited = false;
}

/// Ends devices whose deaths were among lost messages.
void HostApplication::miss_devices() {
    std::erase_if(awaited_, [this](const auto &one) {
        Node &node = nodes_[one.first];
        // After a missing message another birth follows.
        if (now_.at_s < one.second || !node.isInOrder) {
            return false;
        }
        for (auto &[device, facts] : node.devices) {
            if (facts.isAwaited) {
                set_alive(node, {one.first, device}, false, now_of(node));
            }
        }
        return true;
    });
}

Batch HostApplication::take_batch() {
    if (batch_.readings.size() > settings_.batch_readings) {
        // Receipts cover all received messages, so they are part of the last batch.
        const auto end = batch_.readings.begin() + static_cast<std::ptrdiff_t>(settings_.batch_readings);
        Batch part;
        part.new_series = std::exchange(batch_.new_series, {});
        part.readings.assign(std::move_iterator(batch_.readings.begin()), std::move_iterator(end));
        batch_.readings.erase(batch_.readings.begin(), end);
        return part;
    }
    Batch batch = std::exchange(batch_, {});
    for (const NodeName &name : std::exchange(unstored_, {})) {
        batch.receipts.push_back({name, nodes_[name].position});
    }
    return batch;
}

void HostApplication::stored(const std::vector<NodeReceipt> &receipts) {
    for (const NodeReceipt &one : receipts) {
        const auto node = nodes_.find(one.node);
        const bool isOfThisBirth = node != nodes_.end() && node->second.position.birth == one.receipt.birth &&
                                   node->second.position.bdseq == one.receipt.bdseq;
        if (isOfThisBirth) {
            receipts_[one.node] = one.receipt;
        }
    }
}

/// Machines that ended while this host was offline sent their death without a receiver.
void HostApplication::take_census() {
    census_s_ = census_s_.value_or(now_.at_s + settings_.census_s);
    if (!isOnline_ || isCounted_ || now_.at_s < *census_s_) {
        return;
    }
    isCounted_ = true;
    Census census{{}, settings_.groups};
    for (const auto &[name, node] : nodes_) {
        for (const auto &[device, facts] : node.devices) {
            if (facts.isAlive) {
                census.present.push_back({name, device});
            }
        }
    }
    batch_.census = std::move(census);
}

void HostApplication::step(const Moment &now) {
    now_ = now;
    take_census();
    if (now_.at_s < receipts_s_) {
        return;
    }
    receipts_s_ = now_.at_s + RECEIPT_PERIOD_S;
    miss_devices();
    std::erase_if(receipts_, [this](const auto &one) {
        Node &node = nodes_[one.first];
        if (now_.at_s - node.receipt_s < settings_.receipt_s) {
            return false;
        }
        node.receipt_s = now_.at_s;
        link_.publish({publish::receipt_topic(settings_.name, one.first.group, one.first.node),
                       publish::write_receipt(one.second), 0, false});
        return true;
    });
}

}  // namespace mw::shop
