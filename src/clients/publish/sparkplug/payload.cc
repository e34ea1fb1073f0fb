// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/publish/sparkplug/payload.hh"

#include <bit>
#include <limits>

#include "base/overloaded.hh"
#include "sparkplug_b.pb.h"

namespace mw::publish {
namespace {

using Wire = millwright::sparkplug::Payload;

void write_value(const Value &value, Wire::Metric &metric) {
    std::visit(
        Overloaded{[&](std::monostate) { metric.set_is_null(true); },
                   [&](bool on) { metric.set_boolean_value(on); },
                   [&](std::int64_t number) { metric.set_long_value(std::bit_cast<std::uint64_t>(number)); },
                   [&](std::uint64_t number) { metric.set_long_value(number); },
                   [&](double number) { metric.set_double_value(number); },
                   [&](const std::string &text) { metric.set_string_value(text); }},
        value);
}

Value read_value(const Wire::Metric &metric, std::optional<DataType> type) {
    if (metric.is_null()) {
        return {};
    }
    switch (metric.value_case()) {
    case Wire::Metric::kIntValue:
    case Wire::Metric::kLongValue: {
        const std::uint64_t number = metric.has_int_value() ? metric.int_value() : metric.long_value();
        return type == DataType::INT64 ? Value(std::bit_cast<std::int64_t>(number)) : Value(number);
    }
    case Wire::Metric::kFloatValue: return static_cast<double>(metric.float_value());
    case Wire::Metric::kDoubleValue: return metric.double_value();
    case Wire::Metric::kBooleanValue: return metric.boolean_value();
    case Wire::Metric::kStringValue: return metric.string_value();
    default: return {};
    }
}

void write_metric(const PayloadMetric &from, Wire::Metric &to) {
    if (!from.name.empty()) {
        to.set_name(from.name);
    }
    if (from.alias.has_value()) {
        to.set_alias(*from.alias);
    }
    if (from.at.has_value()) {
        to.set_timestamp(*from.at);
    }
    if (from.type.has_value()) {
        to.set_datatype(static_cast<std::uint32_t>(*from.type));
    }
    if (from.isHistorical) {
        to.set_is_historical(true);
    }
    if (!from.unit.empty()) {
        auto &properties = *to.mutable_properties();
        properties.add_keys("engUnit");
        auto &unit = *properties.add_values();
        unit.set_type(static_cast<std::uint32_t>(DataType::STRING));
        unit.set_string_value(from.unit);
    }
    write_value(from.value, to);
}

std::optional<DataType> type_of_number(std::uint32_t number) {
    for (const DataType type :
         {DataType::INT64, DataType::UINT64, DataType::DOUBLE, DataType::BOOLEAN, DataType::STRING}) {
        if (static_cast<std::uint32_t>(type) == number) {
            return type;
        }
    }
    return std::nullopt;
}

}  // namespace

std::string encode(const Payload &payload) {
    Wire wire;
    if (payload.at.has_value()) {
        wire.set_timestamp(*payload.at);
    }
    if (payload.seq.has_value()) {
        wire.set_seq(*payload.seq);
    }
    if (payload.position.has_value()) {
        wire.set_millwright_birth(payload.position->birth);
        wire.set_millwright_count(payload.position->count);
    }
    for (const PayloadMetric &metric : payload.metrics) {
        write_metric(metric, *wire.add_metrics());
    }
    return wire.SerializeAsString();
}

std::optional<Payload> decode_payload(std::string_view bytes) {
    Wire wire;
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
        !wire.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
        return std::nullopt;
    }
    Payload payload;
    payload.at = wire.has_timestamp() ? std::optional(wire.timestamp()) : std::nullopt;
    payload.seq = wire.has_seq() ? std::optional(wire.seq()) : std::nullopt;
    if (wire.has_millwright_birth() && wire.has_millwright_count()) {
        payload.position = Position{wire.millwright_birth(), wire.millwright_count()};
    }
    for (const Wire::Metric &metric : wire.metrics()) {
        PayloadMetric one;
        one.name = metric.name();
        one.alias = metric.has_alias() ? std::optional(metric.alias()) : std::nullopt;
        one.at = metric.has_timestamp() ? std::optional(metric.timestamp()) : std::nullopt;
        one.type = type_of_number(metric.datatype());
        one.type_number = metric.datatype();
        one.isHistorical = metric.is_historical();
        for (int i = 0; i < metric.properties().keys_size() && i < metric.properties().values_size(); ++i) {
            if (metric.properties().keys(i) == "engUnit") {
                one.unit = metric.properties().values(i).string_value();
            }
        }
        one.value = read_value(metric, one.type);
        payload.metrics.push_back(std::move(one));
    }
    return payload;
}

}  // namespace mw::publish
