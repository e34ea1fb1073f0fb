// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/edge_node.hh"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/overloaded.hh"
#include "clients/publish/sparkplug/host_state.hh"

namespace mw::publish {
namespace {

constexpr std::string_view NAMESPACE = "spBv1.0";
constexpr const char *REBIRTH = "Node Control/Rebirth";
constexpr const char *DROPPED = "Store/Dropped Records";
constexpr std::uint64_t BDSEQ_ALIAS = 1, REBIRTH_ALIAS = 2, SOFTWARE_ALIAS = 3, DROPPED_ALIAS = 4,
                        FIRST_DEVICE_ALIAS = 100;
constexpr std::uint64_t LAST_BDSEQ = 255;

}  // namespace

std::string check_topic_part(std::string_view name) {
    if (name.empty()) {
        return "a name is missing";
    }
    const std::size_t bad = name.find_first_of("+/#");
    if (bad != std::string_view::npos) {
        return fmt::format("'{}' is reserved in topics of MQTT", name[bad]);
    }
    return clean_text(name) == name ? "" : "the name is not valid UTF-8, or has control characters";
}

EdgeNode::EdgeNode(NodeSettings settings, LiveData &data, BrokerLink &link, std::uint64_t bdseq,
                   KeepNumber keep, Report report)
    : settings_(std::move(settings)), data_(data), link_(link), keep_(std::move(keep)),
      report_(std::move(report)), retry_s_(settings_.first_retry_s),
      next_bdseq_(bdseq > LAST_BDSEQ ? 0 : bdseq), delivery_(settings_.delivery) {}

std::string EdgeNode::topic(std::string_view type, bool isOfDevice) const {
    std::string text = fmt::format("{}/{}/{}/{}", NAMESPACE, settings_.group, type, settings_.node);
    return isOfDevice ? text + '/' + settings_.device : text;
}

void EdgeNode::send(std::string_view type, bool isOfDevice, Payload payload) {
    payload.at = payload.at.value_or(now_.utc_ms);
    payload.seq = seq_++;
    delivery_.message_sent();
    if (delivery_.hasReceipts()) {
        payload.position = Position{birth_, delivery_.sent()};
    }
    link_.publish({topic(type, isOfDevice), encode(payload)});
}

Publication EdgeNode::death() const {
    Payload payload{.at = now_.utc_ms};
    payload.metrics.push_back({.name = "bdSeq",
                               .at = now_.utc_ms,
                               .type = DataType::INT64,
                               .value = static_cast<std::int64_t>(bdseq_)});
    return {topic("NDEATH", false), encode(payload), 1, false};
}

void EdgeNode::connect() {
    bdseq_ = next_bdseq_;
    next_bdseq_ = bdseq_ == LAST_BDSEQ ? 0 : bdseq_ + 1;
    keep_(next_bdseq_);
    phase_ = Phase::CONNECTING;
    phase_end_s_ = now_.at_s + settings_.answer_s;
    link_.connect(broker_, death());
}

void EdgeNode::connected() {
    isRebirthDue_ = false;
    isDeviceBorn_ = false;
    host_at_.reset();
    isHostOnline_ = false;
    hasReceipts_ = false;
    phase_ = Phase::HOST_AWAITED;
    phase_end_s_ = now_.at_s + settings_.answer_s;
    link_.subscribe(topic("NCMD", false));
    if (!settings_.primary_host.empty()) {
        link_.subscribe(fmt::format("{}/STATE/{}", NAMESPACE, settings_.primary_host));
        link_.subscribe(receipt_topic(settings_.primary_host, settings_.group, settings_.node));
    }
    if (settings_.primary_host.empty()) {
        bear_node();
    }
}

/// Called when the connection is lost.
void EdgeNode::lose(const std::string &why) {
    const bool wasOnline = phase_ == Phase::ONLINE;
    if (!std::exchange(hasReported_, true) || wasOnline) {
        report_(why);
    }
    phase_ = Phase::WAITING;
    phase_end_s_ = now_.at_s + (wasOnline ? settings_.first_retry_s : retry_s_);
    retry_s_ = wasOnline ? settings_.first_retry_s : std::min(2 * retry_s_, settings_.longest_retry_s);
    broker_ = (broker_ + 1) % std::max<std::size_t>(settings_.brokers, 1);
}

/// Ends an active session by the rules for the end of a node.
void EdgeNode::leave(const std::string &why) {
    if (phase_ == Phase::ONLINE) {
        link_.publish(death());
    }
    link_.disconnect();
    lose(why);
}

void EdgeNode::end(const Moment &now) {
    now_ = now;
    if (phase_ == Phase::ONLINE) {
        link_.publish(death());
    }
    if (phase_ == Phase::ONLINE || phase_ == Phase::HOST_AWAITED) {
        link_.disconnect();
    } else {
        link_.drop();
    }
    phase_ = Phase::WAITING;
}

void EdgeNode::take_state(std::string_view payload) {
    const auto state = read_host_state(payload);
    // A broker may deliver an older state later, so only a newer state is used.
    if (!state.has_value() || (host_at_.has_value() && state->at < *host_at_)) {
        return;
    }
    host_at_ = state->at;
    isHostOnline_ = state->isOnline;
    hasReceipts_ = state->hasReceipts;
    if (isHostOnline_ && phase_ == Phase::HOST_AWAITED) {
        bear_node();
    } else if (!isHostOnline_ && phase_ == Phase::HOST_AWAITED) {
        phase_end_s_ = now_.at_s;  // the host may be at another broker
    } else if (!isHostOnline_ && phase_ == Phase::ONLINE) {
        leave(fmt::format("The primary host {} is offline. Values are stored on the disk.",
                          settings_.primary_host));
    }
}

bool EdgeNode::isRebirthRequested(std::string_view payload) const {
    const auto command = decode_payload(payload);
    return command.has_value() && std::ranges::any_of(command->metrics, [](const PayloadMetric &metric) {
               const bool isOurs =
                   metric.name == REBIRTH || (metric.name.empty() && metric.alias == REBIRTH_ALIAS);
               return isOurs && metric.value == Value(true);
           });
}

void EdgeNode::take_message(const Publication &message) {
    if (message.topic == topic("NCMD", false)) {
        // A request received before the birth is answered by the birth.
        isRebirthDue_ = isRebirthDue_ || (phase_ == Phase::ONLINE && isRebirthRequested(message.payload));
    } else if (!settings_.primary_host.empty() &&
               message.topic == fmt::format("{}/STATE/{}", NAMESPACE, settings_.primary_host)) {
        take_state(message.payload);
    } else if (message.topic == receipt_topic(settings_.primary_host, settings_.group, settings_.node)) {
        take_receipt(message.payload);
    }
}

void EdgeNode::take_receipt(std::string_view payload) {
    const auto receipt = read_receipt(payload);
    if (receipt.has_value() && phase_ == Phase::ONLINE && receipt->bdseq == bdseq_ &&
        receipt->birth == birth_) {
        delivery_.received(receipt->count);
    }
}

void EdgeNode::take(const LinkEvent &event) {
    std::visit(Overloaded{[this](const Connected &) { connected(); },
                          [this](const Disconnected &what) { lose(what.reason); },
                          [this](const Publication &message) { take_message(message); },
                          [this](const BarrierPassed &what) { delivery_.barrier_passed(what.barrier); }},
               event);
}

void EdgeNode::bear_node() {
    const LiveData::State state = data_.state();
    // A host requests a birth when it has missed messages, so records that are not confirmed are sent again.
    delivery_.begin(state.confirmed, hasReceipts_);
    birth_ = std::max(now_.utc_ms, birth_ + 1);
    seq_ = 0;
    isRebirthDue_ = false;
    told_dropped_ = state.dropped;
    const TimeMs at = now_.utc_ms;
    Payload birth{.at = birth_};
    birth.metrics = {
        {.name = "bdSeq",
         .alias = BDSEQ_ALIAS,
         .at = at,
         .type = DataType::INT64,
         .value = static_cast<std::int64_t>(bdseq_)},
        {.name = REBIRTH, .alias = REBIRTH_ALIAS, .at = at, .type = DataType::BOOLEAN, .value = false},
        {.name = "Properties/Software",
         .alias = SOFTWARE_ALIAS,
         .at = at,
         .type = DataType::STRING,
         .value = settings_.software},
        {.name = DROPPED,
         .alias = DROPPED_ALIAS,
         .at = at,
         .type = DataType::UINT64,
         .value = state.dropped}};
    send("NBIRTH", false, std::move(birth));
    if (phase_ != Phase::ONLINE && std::exchange(hasReported_, false)) {
        report_("Connected to the broker.");
    }
    phase_ = Phase::ONLINE;
    retry_s_ = settings_.first_retry_s;
    isDeviceBorn_ = false;
    follow_machine();
}

void EdgeNode::bear_device() {
    const Picture picture = data_.picture();
    aliases_.clear();
    Payload birth;
    for (std::size_t i = 0; i < picture.definitions.size(); ++i) {
        const Definition &definition = picture.definitions[i];
        const std::uint64_t alias = FIRST_DEVICE_ALIAS + i;
        aliases_[definition.name] = alias;
        birth.metrics.push_back({.name = definition.name,
                                 .alias = alias,
                                 .at = picture.times[i],
                                 .type = definition.type,
                                 .unit = definition.unit,
                                 .value = picture.values[i]});
    }
    send("DBIRTH", true, std::move(birth));
    isDeviceBorn_ = true;
    generation_ = picture.generation;
    // Records since the last message, and records that waited for the broker, are history; the birth contains
    // their newest values.
    delivery_.birth(picture.next);
}

void EdgeNode::bury_device() {
    send("DDEATH", true, {});
    isDeviceBorn_ = false;
}

void EdgeNode::follow_machine() {
    const LiveData::State state = data_.state();
    if (isDeviceBorn_ && (!state.isAlive || state.generation != generation_)) {
        publish_live(state);
        bury_device();
    }
    if (!isDeviceBorn_ && state.isAlive) {
        bear_device();
    }
}

bool EdgeNode::add_record(const Record &record, bool isHistorical, Payload &into) {
    auto stored = decode_payload(record.bytes);
    if (!stored.has_value()) {
        return false;
    }
    const std::size_t before = into.metrics.size();
    for (PayloadMetric &metric : stored->metrics) {
        const auto alias = aliases_.find(metric.name);
        if (alias != aliases_.end()) {  // a machine with changed settings has other metrics
            into.metrics.push_back({.alias = alias->second,
                                    .at = stored->at,
                                    .type = settings_.isTyped ? metric.type : std::nullopt,
                                    .isHistorical = isHistorical,
                                    .value = std::move(metric.value)});
        }
    }
    return into.metrics.size() > before;
}

void EdgeNode::publish_live(const LiveData::State &state) {
    while (delivery_.live() < state.next && delivery_.hasRoom()) {
        const auto records = data_.read(delivery_.live(), 1);
        const bool isOfThisBirth = state.generation == generation_ || !state.isAlive;
        if (records.empty() || !isOfThisBirth) {
            return;  // becomes history of the next birth
        }
        Payload payload;
        if (add_record(records.front(), false, payload)) {
            send("DDATA", true, std::move(payload));
        }
        delivery_.set_live(records.front().id + 1);
    }
}

void EdgeNode::publish_history() {
    while (delivery_.history() < delivery_.history_end() && !delivery_.isHalfFull()) {
        const auto most = std::min<RecordId>(settings_.batch, delivery_.history_end() - delivery_.history());
        const auto records = data_.read(delivery_.history(), most);
        if (records.empty()) {
            delivery_.set_history(delivery_.history_end());
            return;
        }
        Payload payload;
        for (const Record &record : records) {
            static_cast<void>(add_record(record, true, payload));
        }
        if (!payload.metrics.empty()) {
            send("DDATA", true, std::move(payload));
        }
        delivery_.set_history(records.back().id + 1);
    }
}

void EdgeNode::publish_counts(const LiveData::State &state) {
    if (state.dropped != told_dropped_) {
        told_dropped_ = state.dropped;
        Payload payload;
        payload.metrics.push_back({.alias = DROPPED_ALIAS, .at = now_.utc_ms, .value = state.dropped});
        send("NDATA", false, std::move(payload));
    }
}

void EdgeNode::follow_broker() {
    delivery_.step_sent(now_.at_s);
    if (const auto end = delivery_.confirmed(now_.at_s); end.has_value()) {
        data_.confirm(*end);
    }
    if (delivery_.isBarrierDue(now_.at_s)) {
        delivery_.barrier_sent(link_.barrier(), now_.at_s);
    }
}

void EdgeNode::step(const Moment &now) {
    now_ = now;
    while (const auto event = link_.next_event()) {
        take(*event);
    }
    const bool isOver = now_.at_s >= phase_end_s_;
    switch (phase_) {
    case Phase::WAITING:
        if (isOver) {
            connect();
        }
        return;
    case Phase::CONNECTING:
        if (isOver) {
            link_.drop();
            lose("The broker does not answer.");
        }
        return;
    case Phase::HOST_AWAITED:
        // With several brokers the host may be at another broker.
        if (isOver && settings_.brokers > 1) {
            link_.disconnect();
            lose(fmt::format("The primary host {} is not connected to this broker.", settings_.primary_host));
        }
        return;
    case Phase::ONLINE: break;
    }
    const auto since_s = delivery_.waiting_since();
    if (since_s.has_value() && now_.at_s - *since_s > settings_.answer_s) {
        link_.drop();
        lose(delivery_.hasReceipts() ? fmt::format("Host {} does not confirm values.", settings_.primary_host)
                                     : "The broker does not answer.");
        return;
    }
    if (isRebirthDue_) {
        bear_node();
    }
    follow_machine();
    if (isDeviceBorn_) {
        publish_live(data_.state());
        publish_history();
    }
    publish_counts(data_.state());
    follow_broker();
}

}  // namespace mw::publish
