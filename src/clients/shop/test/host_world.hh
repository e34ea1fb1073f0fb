// SPDX-License-Identifier: GPL-2.0-or-later
// A host application with a simulated store, in virtual time.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "clients/publish/test/node_world.hh"
#include "clients/shop/host/host_application.hh"

namespace mw::shop {

using publish::DataType;
using publish::NodeSettings;
using publish::NodeWorld;
using publish::Packet;
using publish::Payload;
using publish::PayloadMetric;
using publish::PlayedBroker;
using publish::Publication;

class HostWorld {
  public:
    explicit HostWorld(std::size_t batch_readings = 1000)
        : host({.name = "shop", .groups = {}, .batch_readings = batch_readings}, broker,
               [this](const std::string &what) { reports.push_back(what); }) {
        host.connected();
    }
    void take(const Publication &message) { host.take(message, now()); }
    void take(const std::string &type, Payload payload, const std::string &device = "") {
        const std::string topic = "spBv1.0/shop/" + type + "/mill-1" + (device.empty() ? "" : "/" + device);
        take(Publication{topic, encode(payload), 0, false});
    }
    /// The next message of a node that counts its messages.
    void take_counted(const std::string &type, Payload payload, const std::string &device = "") {
        position.count = type == "NBIRTH" ? 1 : position.count + 1;
        position.birth = type == "NBIRTH" ? *payload.at : position.birth;
        payload.position = position;
        take(type, payload, device);
    }
    /// A node with the device Mill and its metric Count, alias 100.
    void bear(TimeMs birth, DataType type = DataType::INT64) {
        Payload node{.at = birth, .seq = 0};
        node.metrics.push_back(
            {.name = "bdSeq", .at = birth, .type = DataType::INT64, .value = std::int64_t{7}});
        take_counted("NBIRTH", node);
        Payload device{.at = birth, .seq = 1};
        device.metrics.push_back(
            {.name = "Count", .alias = 100, .at = birth, .type = type, .value = std::int64_t{0}});
        take_counted("DBIRTH", device, "Mill");
    }
    /// Message number `seq` of the birth.
    void count(std::uint64_t seq, TimeMs at, std::uint64_t value) {
        Payload data{.at = at, .seq = seq};
        data.metrics.push_back({.alias = 100, .at = at, .value = value});
        position.count = seq;
        take_counted("DDATA", data, "Mill");
    }
    HostApplication::Moment now() const {
        return {1'700'000'000'000 + static_cast<TimeMs>(now_s * 1000), now_s};
    }
    /// Stores as a working store does; returns the sent receipts.
    std::vector<Receipt> store() {
        batches.push_back(host.take_batch());
        broker.packets.clear();
        now_s += 1;
        host.stored(batches.back().receipts);
        host.step(now());
        std::vector<Receipt> sent;
        for (const Packet &packet : broker.packets) {
            if (packet.message.topic == "millwright/stored/shop/shop/mill-1") {
                sent.push_back(publish::read_receipt(packet.message.payload).value());
            }
        }
        return sent;
    }
    std::size_t births_requested() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            broker.packets, [](const Packet &packet) { return packet.verb() == "NCMD"; }));
    }

    PlayedBroker broker;
    std::vector<std::string> reports;
    HostApplication host;
    std::vector<Batch> batches;
    double now_s = 100;
    publish::Position position;  ///< position of the last message
};

}  // namespace mw::shop
