// SPDX-License-Identifier: GPL-2.0-or-later
// Checks of Sparkplug's assertions on the packets of one long session of an edge node.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "clients/publish/test/node_world.hh"

namespace mw::publish {

using Packets = std::vector<Packet>;

/// The session: a machine that works, a rebirth, more messages than sequence numbers, a machine that ends and
/// restarts, a broker that is lost and returns, an end.
inline std::unique_ptr<NodeWorld> long_session() {
    auto world = std::make_unique<NodeWorld>();
    world->bear_machine();
    world->run(1);
    for (int i = 0; i < 300; ++i) {
        world->count(i);
        world->run(0.1);
    }
    world->command("Node Control/Rebirth", true);
    world->run(1);
    world->count(1000);
    world->run(1);
    world->data->gone();
    world->run(1);
    world->bear_machine();
    world->run(1);
    world->broker.isThere = false;
    world->lose();
    for (int i = 0; i < 20; ++i) {
        world->count(2000 + i);
        world->run(0.2);
    }
    world->broker.isThere = true;
    world->run(60);
    world->count(3000);
    world->run(5);
    world->node->end({world->utc(), world->now_s});
    return world;
}

inline const NodeWorld &session() {
    static const std::unique_ptr<NodeWorld> WORLD = long_session();
    return *WORLD;
}

inline std::unique_ptr<NodeWorld> session_with_host() {
    auto world = std::make_unique<NodeWorld>(NodeSettings{.primary_host = "scada"});
    world->bear_machine();
    world->run(3);
    world->broker.events.emplace_back(
        Publication{"spBv1.0/STATE/scada", R"({"online":true,"timestamp":1000})", 1, false});
    world->run(1);
    world->broker.events.emplace_back(
        Publication{"spBv1.0/STATE/scada", R"({"online":false,"timestamp":999})", 1, false});
    world->run(1);
    world->broker.events.emplace_back(
        Publication{"spBv1.0/STATE/scada", R"({"online":false,"timestamp":2000})", 1, false});
    world->run(0.2);
    return world;
}

inline const NodeWorld &hosted() {
    static const std::unique_ptr<NodeWorld> WORLD = session_with_host();
    return *WORLD;
}

inline bool isEach(const std::string &verb, const std::function<bool(const Packet &)> &holds) {
    const Packets all = session().of(verb);
    return !all.empty() && std::ranges::all_of(all, holds);
}
inline bool areEach(std::initializer_list<const char *> verbs,
                    const std::function<bool(const Packet &)> &holds) {
    return std::ranges::all_of(verbs, [&](const char *verb) { return isEach(verb, holds); });
}
inline bool isPlain(const Packet &packet) {
    return packet.message.qos == 0 && !packet.message.isRetained;
}
inline bool hasTime(const Packet &packet) {
    return packet.payload().at.value_or(0) > 1'700'000'000'000;
}
inline const PayloadMetric *find(const Payload &payload, const std::string &name) {
    const auto found = std::ranges::find(payload.metrics, name, &PayloadMetric::name);
    return found == payload.metrics.end() ? nullptr : &*found;
}
inline Value value_of(const Packet &packet, const std::string &name) {
    const Payload payload = packet.payload();
    const auto *const metric = find(payload, name);
    return metric == nullptr ? Value() : metric->value;
}

/// Sequence numbers increase by one from message to message; NBIRTH has 0.
inline bool areNumbersConsecutive(const std::string &of_verb) {
    std::uint64_t expected = 0;
    std::size_t checked = 0;
    for (const Packet &packet : session().broker.packets) {
        const std::string verb = packet.verb();
        if (verb.empty() || verb == "NDEATH") {
            continue;
        }
        expected = verb == "NBIRTH" ? 0 : (expected + 1) % 256;
        if (verb == of_verb || of_verb.empty()) {
            ++checked;
            if (packet.payload().seq != expected) {
                return false;
            }
        }
    }
    return checked > 0;
}

/// For each connection: the will and the births after it.
inline bool areDeathsMatching() {
    Value will;
    std::size_t births = 0;
    for (const Packet &packet : session().broker.packets) {
        if (packet.type == Packet::Type::CONNECT) {
            will = value_of(packet, "bdSeq");
        }
        if (packet.verb() == "NBIRTH" || packet.verb() == "NDEATH") {
            ++births;
            if (value_of(packet, "bdSeq") != will) {
                return false;
            }
        }
    }
    return births > 2;
}
inline bool isCounted() {
    std::int64_t expected = 0;
    for (const Packet &packet : session().broker.packets) {
        if (packet.type == Packet::Type::CONNECT && value_of(packet, "bdSeq") != Value(expected++)) {
            return false;
        }
    }
    return expected > 2;
}
inline bool isCountedInARing() {
    NodeWorld world;
    world.bdseq = 255;
    world.kill();
    world.start();
    world.run(0.2);
    return value_of(world.broker.packets.front(), "bdSeq") == Value(std::int64_t{255}) && world.bdseq == 0;
}

/// Only births between NBIRTH and the first DBIRTH while the machine is running.
inline bool areBirthsFirst() {
    const auto verbs = session().verbs();
    for (std::size_t i = 0; i + 1 < verbs.size(); ++i) {
        if (verbs[i] == "NBIRTH" && verbs[i + 1] != "DBIRTH") {
            return false;
        }
    }
    return verbs.front() == "NBIRTH";
}
inline bool isNoDataBeforeBirth() {
    bool isNodeBorn = false, isDeviceBorn = false;
    for (const Packet &packet : session().broker.packets) {
        const std::string verb = packet.verb();
        isNodeBorn = packet.type == Packet::Type::CONNECT ? false : isNodeBorn || verb == "NBIRTH";
        isDeviceBorn = packet.type == Packet::Type::CONNECT || verb == "DDEATH" || verb == "NBIRTH"
                           ? false
                           : isDeviceBorn || verb == "DBIRTH";
        if ((verb == "DDATA" && !isDeviceBorn) || (verb == "NDATA" && !isNodeBorn) ||
            (verb == "DBIRTH" && !isNodeBorn)) {
            return false;
        }
    }
    return true;
}
inline bool areAliasesUnique() {
    std::set<std::uint64_t> seen;
    std::size_t count = 0;
    for (const char *verb : {"NBIRTH", "DBIRTH"}) {
        for (const PayloadMetric &metric : session().of(verb).front().payload().metrics) {
            seen.insert(metric.alias.value());
            ++count;
        }
    }
    return seen.size() == count;
}
inline bool areDataKnown() {
    std::set<std::uint64_t> born;
    for (const PayloadMetric &metric : session().of("DBIRTH").front().payload().metrics) {
        born.insert(metric.alias.value());
    }
    return isEach("DDATA", [&born](const Packet &packet) {
        const Payload payload = packet.payload();
        return std::ranges::all_of(payload.metrics, [&born](const PayloadMetric &metric) {
            return metric.name.empty() && metric.alias.has_value() && born.contains(*metric.alias);
        });
    });
}
inline bool areValuesChanges() {
    std::map<std::uint64_t, Value> last;
    for (const Packet &packet : session().broker.packets) {
        const std::string verb = packet.verb();
        if (verb != "DBIRTH" && verb != "DDATA") {
            continue;
        }
        for (const PayloadMetric &metric : packet.payload().metrics) {
            const bool isRepeated =
                verb == "DDATA" && !metric.isHistorical && last[*metric.alias] == metric.value;
            if (isRepeated) {
                return false;
            }
            last[*metric.alias] = metric.isHistorical ? last[*metric.alias] : metric.value;
        }
    }
    return true;
}
inline bool areTimesInOrder() {
    TimeMs last = 0;
    for (const Packet &packet : session().broker.packets) {
        if (packet.verb() != "DDATA") {
            continue;
        }
        for (const PayloadMetric &metric : packet.payload().metrics) {
            if (!metric.isHistorical && metric.at.value() < std::exchange(last, *metric.at)) {
                return false;
            }
        }
    }
    return last > 0;
}
inline bool isEndOrderly() {
    const Packets &all = session().broker.packets;
    return all[all.size() - 2].verb() == "NDEATH" && all.back().type == Packet::Type::DISCONNECT;
}
inline bool isRebirthComplete() {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.broker.packets.clear();
    world.count(1);
    world.command("Node Control/Rebirth", true);
    world.run(0.05);
    const auto verbs = world.verbs();
    return verbs.size() >= 2 && verbs[0] == "NBIRTH" && verbs[1] == "DBIRTH" &&
           value_of(world.of("NBIRTH").front(), "bdSeq") == Value(std::int64_t{0});
}
inline bool isOtherCommandIgnored() {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.broker.packets.clear();
    world.command("Node Control/Rebirth", false);
    world.command("State", std::string("OFF"));
    world.broker.events.emplace_back(
        Publication{"spBv1.0/shop/NCMD/mill-1", "\xFF\xFF no payload", 0, false});
    world.run(1);
    return world.verbs().empty();
}
inline bool isDeviceBuried() {
    const auto verbs = session().verbs();
    const auto death = std::ranges::find(verbs, "DDEATH");
    return death != verbs.end() && death + 1 != verbs.end() && *(death + 1) == "DBIRTH";
}
inline bool isHostAwaited() {
    const Packets &all = hosted().broker.packets;
    const auto isOnHost = [](const Packet &packet) {
        return packet.type == Packet::Type::SUBSCRIBE && packet.message.topic == "spBv1.0/STATE/scada" &&
               packet.message.qos == 1;
    };
    NodeWorld silent(NodeSettings{.primary_host = "scada"});
    silent.bear_machine();
    silent.run(5);
    return std::ranges::any_of(all, isOnHost) && silent.verbs().empty() && hosted().of("NBIRTH").size() == 1;
}
inline bool isHostOfflineFollowed() {
    const auto verbs = hosted().verbs();
    const Packets &all = hosted().broker.packets;
    const auto death = std::ranges::find_if(all, [](const Packet &one) { return one.verb() == "NDEATH"; });
    return verbs.back() == "NDEATH" && death != all.end() && (death + 1)->type == Packet::Type::DISCONNECT;
}
inline bool isOlderStateIgnored() {
    NodeWorld world(NodeSettings{.primary_host = "scada"});
    for (const char *state : {R"({"online":true,"timestamp":1000})", R"({"online":false,"timestamp":999})",
                              R"({"online":"no","timestamp":5000})", "OFFLINE"}) {
        world.run(0.2);
        world.broker.events.emplace_back(Publication{"spBv1.0/STATE/scada", state, 1, false});
    }
    world.run(1);
    return world.verbs() == std::vector<std::string>{"NBIRTH"} && world.node->isOnline();
}
inline bool isAnotherBrokerTried() {
    NodeWorld world(NodeSettings{.primary_host = "scada", .brokers = 2});
    world.broker.state = R"({"online":false,"timestamp":5})";
    world.run(5);
    std::set<std::size_t> tried;
    for (const Packet &packet : world.broker.packets) {
        if (packet.type == Packet::Type::CONNECT) {
            tried.insert(packet.broker);
        }
    }
    return tried.size() == 2 && world.verbs().empty();
}
inline bool isOneConnection() {
    int open = 0;
    for (const Packet &packet : session().broker.packets) {
        const bool isEnd = packet.type == Packet::Type::DISCONNECT || packet.type == Packet::Type::DROP;
        open = packet.type == Packet::Type::CONNECT ? 1 : isEnd ? 0 : open;
    }
    return open == 0;
}

struct Assertion {
    const char *id;
    std::function<bool()> holds;
};

inline bool isWill(const std::function<bool(const Publication &)> &holds) {
    return std::ranges::all_of(session().broker.packets, [&](const Packet &packet) {
        return packet.type != Packet::Type::CONNECT || holds(packet.message);
    });
}
inline bool isBdSeqAlone(const Publication &death) {
    const auto payload = decode_payload(death.payload);
    return payload.has_value() && payload->metrics.size() == 1 && payload->metrics[0].name == "bdSeq" &&
           !payload->seq.has_value();
}
inline bool hasRebirth(const Packet &packet) {
    const Payload payload = packet.payload();
    const auto *const metric = find(payload, "Node Control/Rebirth");
    return metric != nullptr && metric->type == DataType::BOOLEAN && metric->value == Value(false);
}
inline bool isWholeBirth(const Packet &packet) {
    const Payload payload = packet.payload();
    return std::ranges::all_of(payload.metrics, [](const PayloadMetric &metric) {
        return !metric.name.empty() && metric.alias.has_value() && metric.at.has_value() &&
               metric.type.has_value() && metric.value != Value();
    });
}
inline bool areMetricsTimed(const Packet &packet) {
    const Payload payload = packet.payload();
    return std::ranges::all_of(payload.metrics,
                               [](const PayloadMetric &metric) { return metric.at.has_value(); });
}
inline bool areTypesAbsent(const Packet &packet) {
    const Payload payload = packet.payload();
    return std::ranges::none_of(payload.metrics,
                                [](const PayloadMetric &metric) { return metric.type.has_value(); });
}
inline bool isTopic(const char *verb, const char *topic) {
    return isEach(verb, [topic](const Packet &packet) { return packet.message.topic == topic; });
}
inline bool isDeviceInEachBirth() {
    return isEach("DBIRTH", [](const Packet &packet) { return packet.payload().metrics.size() == 3; });
}
inline bool isSubscribed() {
    bool isConnected = false, isSubscribed = false;
    for (const Packet &packet : session().broker.packets) {
        if (packet.type == Packet::Type::CONNECT) {
            isConnected = true;
            isSubscribed = false;
        }
        isSubscribed = isSubscribed || (packet.type == Packet::Type::SUBSCRIBE && packet.message.qos == 1 &&
                                        packet.message.topic == "spBv1.0/shop/NCMD/mill-1");
        if (packet.verb() == "NBIRTH" && !(isConnected && isSubscribed)) {
            return false;
        }
    }
    return isSubscribed;
}
inline bool areUnitsProperties() {
    const Payload payload = session().of("DBIRTH").front().payload();
    return find(payload, "Axes/X/Position")->unit == "mm" && find(payload, "State")->unit.empty();
}
inline bool areNamesChecked() {
    return !check_topic_part("a+b").empty() && !check_topic_part("a/b").empty() &&
           !check_topic_part("a#").empty() && !check_topic_part("").empty() &&
           !check_topic_part("\xFF").empty() && check_topic_part("Fräse 1").empty();
}
inline bool isHistoryMarked() {
    // Values from the time without a broker are sent later as history, with their own times.
    std::set<std::int64_t> sent;
    for (const Packet &packet : session().of("DDATA")) {
        for (const PayloadMetric &metric : packet.payload().metrics) {
            if (metric.isHistorical && std::holds_alternative<std::uint64_t>(metric.value)) {
                sent.insert(static_cast<std::int64_t>(std::get<std::uint64_t>(metric.value)));
            }
        }
    }
    return std::ranges::all_of(std::vector{2000, 2010, 2019}, [&sent](int i) { return sent.contains(i); });
}

inline bool isDeathWithoutSeq() {
    return isEach("NDEATH", [](const Packet &packet) { return !packet.payload().seq.has_value(); });
}
inline bool isNodeTopic(const char *verb) {
    return isTopic(verb, fmt::format("spBv1.0/shop/{}/mill-1", verb).c_str());
}
inline bool isDeviceTopic(const char *verb) {
    return isTopic(verb, fmt::format("spBv1.0/shop/{}/mill-1/Mill", verb).c_str());
}
inline bool isSeqZero() {
    return isEach("NBIRTH", [](const Packet &packet) { return packet.payload().seq == 0U; });
}
inline bool hasSeq(const char *verb) {
    return isEach(verb, [](const Packet &packet) { return packet.payload().seq.has_value(); });
}
inline bool isWillPlain() {
    return isWill([](const Publication &will) { return will.qos == 1 && !will.isRetained; });
}
/// Only the counter of dropped records, a metric of the node, may change.
inline bool isNodeDataRight() {
    NodeWorld world;
    world.bear_machine();
    world.run(1);
    world.broker.isThere = false;
    world.lose();
    world.kill();
    world.data.emplace(
        std::move(*DataLog::open(world.folder.path(), {.bytes = 4096, .segment_bytes = 1024})));
    world.node.emplace(
        world.settings, *world.data, world.broker, world.bdseq, [](std::uint64_t) {}, [](const auto &) {});
    world.broker.isThere = true;
    world.bear_machine();
    world.run(0.2);
    world.broker.isAnswering = false;  // nothing is confirmed
    for (int i = 0; i < 300; ++i) {
        world.count(i);
    }
    world.run(0.2);
    const Packets data = world.of("NDATA");
    return !data.empty() && isPlain(data[0]) && data[0].message.topic == "spBv1.0/shop/NDATA/mill-1" &&
           data[0].payload().metrics.size() == 1 && data[0].payload().metrics[0].alias.has_value() &&
           data[0].payload().seq.has_value() && hasTime(data[0]) && areMetricsTimed(data[0]) &&
           areTypesAbsent(data[0]);
}

}  // namespace mw::publish
