// SPDX-License-Identifier: GPL-2.0-or-later
// The assertions of the Sparkplug specification 3.0 that apply to an edge node with one device that takes no
// commands: one test for each, with its identifier, on the packets of one long session. Assertions of host
// applications, brokers, templates, data sets and of devices with outputs do not apply.
#include <algorithm>
#include <set>
#include <span>

#include "clients/publish/test/session_checks.hh"

namespace mw::publish {
namespace {

const Assertion ALL[] = {
    {"intro-group-id-string", areNamesChecked},
    {"intro-edge-node-id-string", areNamesChecked},
    {"intro-device-id-string", areNamesChecked},
    {"principles-rbe-recommended", areValuesChanges},
    {"principles-birth-certificates-order", areBirthsFirst},
    {"topic-structure", [] { return isNodeTopic("NBIRTH") && isDeviceTopic("DBIRTH"); }},
    {"topic-structure-namespace-a", [] { return isNodeTopic("NBIRTH"); }},
    {"topic-structure-namespace-valid-group-id", areNamesChecked},
    {"topic-structure-namespace-valid-edge-node-id", areNamesChecked},
    {"topic-structure-namespace-valid-device-id", areNamesChecked},
    {"topic-structure-namespace-device-id-associated-message-types",
     [] { return isDeviceTopic("DBIRTH") && isDeviceTopic("DDATA") && isDeviceTopic("DDEATH"); }},
    {"topic-structure-namespace-device-id-non-associated-message-types",
     [] { return isNodeTopic("NBIRTH") && isNodeTopic("NDEATH") && isNodeDataRight(); }},
    {"topics-nbirth-topic", [] { return isNodeTopic("NBIRTH"); }},
    {"topics-nbirth-mqtt", [] { return isEach("NBIRTH", isPlain); }},
    {"topics-nbirth-seq-num", isSeqZero},
    {"topics-nbirth-timestamp", [] { return isEach("NBIRTH", hasTime); }},
    {"topics-nbirth-metric-reqs",
     [] { return isEach("NBIRTH", [](const Packet &one) { return one.payload().metrics.size() == 4; }); }},
    {"topics-nbirth-metrics", [] { return isEach("NBIRTH", isWholeBirth); }},
    {"topics-nbirth-bdseq-included",
     [] { return isEach("NBIRTH", [](const Packet &one) { return value_of(one, "bdSeq") != Value(); }); }},
    {"topics-nbirth-bdseq-matching", areDeathsMatching},
    {"topics-nbirth-bdseq-increment", isCounted},
    {"topics-nbirth-rebirth-metric", [] { return isEach("NBIRTH", hasRebirth); }},
    {"topics-ndata-topic", isNodeDataRight},
    {"topics-ndata-mqtt", isNodeDataRight},
    {"topics-ndata-seq-num", isNodeDataRight},
    {"topics-ndata-timestamp", isNodeDataRight},
    {"topics-ndata-payload", isNodeDataRight},
    {"topics-ndeath-topic", [] { return isNodeTopic("NDEATH"); }},
    {"topics-ndeath-payload",
     [] {
         return isWill(isBdSeqAlone) &&
                isEach("NDEATH", [](const Packet &one) { return isBdSeqAlone(one.message); });
     }},
    {"topics-ndeath-seq", isDeathWithoutSeq},
    {"topics-dbirth-topic", [] { return isDeviceTopic("DBIRTH"); }},
    {"topics-dbirth-mqtt", [] { return isEach("DBIRTH", isPlain); }},
    {"topics-dbirth-seq", [] { return areNumbersConsecutive("DBIRTH"); }},
    {"topics-dbirth-timestamp", [] { return isEach("DBIRTH", hasTime); }},
    {"topics-dbirth-metric-reqs", isDeviceInEachBirth},
    {"topics-dbirth-metrics", [] { return isEach("DBIRTH", isWholeBirth); }},
    {"topics-ddata-topic", [] { return isDeviceTopic("DDATA"); }},
    {"topics-ddata-mqtt", [] { return isEach("DDATA", isPlain); }},
    {"topics-ddata-seq-num", [] { return areNumbersConsecutive("DDATA"); }},
    {"topics-ddata-timestamp", [] { return isEach("DDATA", hasTime); }},
    {"topics-ddata-payload", areDataKnown},
    {"topics-ddeath-topic", [] { return isDeviceTopic("DDEATH"); }},
    {"topics-ddeath-mqtt", [] { return isEach("DDEATH", isPlain); }},
    {"topics-ddeath-seq-num", [] { return areNumbersConsecutive("DDEATH"); }},
    {"message-flow-edge-node-birth-publish-connect", isSubscribed},
    {"message-flow-edge-node-birth-publish-will-message",
     [] { return isWill([](const auto &will) { return !will.topic.empty(); }); }},
    {"message-flow-edge-node-birth-publish-will-message-topic",
     [] { return isWill([](const auto &will) { return will.topic == "spBv1.0/shop/NDEATH/mill-1"; }); }},
    {"message-flow-edge-node-birth-publish-will-message-payload", [] { return isWill(isBdSeqAlone); }},
    {"message-flow-edge-node-birth-publish-will-message-payload-bdSeq", areDeathsMatching},
    {"message-flow-edge-node-birth-publish-will-message-qos", isWillPlain},
    {"message-flow-edge-node-birth-publish-will-message-will-retained", isWillPlain},
    {"message-flow-edge-node-ncmd-subscribe", isSubscribed},
    {"message-flow-edge-node-birth-publish-subscribe", isHostAwaited},
    {"message-flow-edge-node-birth-publish-phid-wait", isHostAwaited},
    {"message-flow-edge-node-birth-publish-phid-wait-id", isHostAwaited},
    {"message-flow-edge-node-birth-publish-phid-wait-online", isHostAwaited},
    {"message-flow-edge-node-birth-publish-phid-wait-timestamp", isOlderStateIgnored},
    {"message-flow-edge-node-birth-publish-phid-offline", isHostOfflineFollowed},
    {"message-flow-edge-node-birth-publish-nbirth-topic", [] { return isNodeTopic("NBIRTH"); }},
    {"message-flow-edge-node-birth-publish-nbirth-payload", [] { return isEach("NBIRTH", isWholeBirth); }},
    {"message-flow-edge-node-birth-publish-nbirth-payload-bdSeq", areDeathsMatching},
    {"message-flow-edge-node-birth-publish-nbirth-payload-seq", isSeqZero},
    {"message-flow-edge-node-birth-publish-nbirth-qos", [] { return isEach("NBIRTH", isPlain); }},
    {"message-flow-edge-node-birth-publish-nbirth-retained", [] { return isEach("NBIRTH", isPlain); }},
    {"message-flow-device-birth-publish-nbirth-wait", isNoDataBeforeBirth},
    {"message-flow-device-birth-publish-dbirth-topic", [] { return isDeviceTopic("DBIRTH"); }},
    {"message-flow-device-birth-publish-dbirth-match-edge-node-topic",
     [] { return isDeviceTopic("DBIRTH"); }},
    {"message-flow-device-birth-publish-dbirth-payload", [] { return isEach("DBIRTH", isWholeBirth); }},
    {"message-flow-device-birth-publish-dbirth-payload-seq", [] { return areNumbersConsecutive("DBIRTH"); }},
    {"message-flow-device-birth-publish-dbirth-qos", [] { return isEach("DBIRTH", isPlain); }},
    {"message-flow-device-birth-publish-dbirth-retained", [] { return isEach("DBIRTH", isPlain); }},
    {"operational-behavior-edge-node-intentional-disconnect-ndeath", isEndOrderly},
    {"operational-behavior-edge-node-intentional-disconnect-packet", isEndOrderly},
    {"operational-behavior-edge-node-termination-host-action-ndeath-node-offline", isHostOfflineFollowed},
    {"operational-behavior-edge-node-termination-host-offline", isHostOfflineFollowed},
    {"operational-behavior-edge-node-termination-host-offline-reconnect", isAnotherBrokerTried},
    {"operational-behavior-edge-node-termination-host-offline-timestamp", isOlderStateIgnored},
    {"operational-behavior-device-ddeath", isDeviceBuried},
    {"operational-behavior-primary-application-state-with-multiple-servers-single-server", isOneConnection},
    {"operational-behavior-primary-application-state-with-multiple-servers-walk", isAnotherBrokerTried},
    {"operational-behavior-data-publish-nbirth", [] { return isEach("NBIRTH", isWholeBirth); }},
    {"operational-behavior-data-publish-nbirth-values", [] { return isEach("NBIRTH", isWholeBirth); }},
    {"operational-behavior-data-publish-nbirth-change",
     [] { return session().of("NDATA").empty() && isNodeDataRight(); }},
    {"operational-behavior-data-publish-nbirth-order", isNodeDataRight},
    {"operational-behavior-data-publish-dbirth", areDataKnown},
    {"operational-behavior-data-publish-dbirth-values", [] { return isEach("DBIRTH", isWholeBirth); }},
    {"operational-behavior-data-publish-dbirth-change", areValuesChanges},
    {"operational-behavior-data-publish-dbirth-order", areTimesInOrder},
    {"operational-behavior-data-commands-rebirth-name", [] { return isEach("NBIRTH", hasRebirth); }},
    {"operational-behavior-data-commands-rebirth-datatype", [] { return isEach("NBIRTH", hasRebirth); }},
    {"operational-behavior-data-commands-rebirth-value", [] { return isEach("NBIRTH", hasRebirth); }},
    {"operational-behavior-data-commands-rebirth-action-1", isRebirthComplete},
    {"operational-behavior-data-commands-rebirth-action-2", isRebirthComplete},
    {"operational-behavior-data-commands-rebirth-action-3", isRebirthComplete},
    {"operational-behavior-data-commands-ncmd-rebirth-value", isOtherCommandIgnored},
    {"payloads-timestamp-in-UTC", [] { return areEach({"NBIRTH", "DBIRTH", "DDATA", "DDEATH"}, hasTime); }},
    {"payloads-sequence-num-always-included",
     [] { return hasSeq("NBIRTH") && hasSeq("DBIRTH") && hasSeq("DDATA") && hasSeq("DDEATH"); }},
    {"payloads-sequence-num-zero-nbirth", isSeqZero},
    {"payloads-sequence-num-incrementing", [] { return areNumbersConsecutive(""); }},
    {"payloads-name-requirement",
     [] { return areEach({"NBIRTH", "DBIRTH"}, isWholeBirth) && areDataKnown(); }},
    {"payloads-alias-uniqueness", areAliasesUnique},
    {"payloads-alias-birth-requirement", [] { return areEach({"NBIRTH", "DBIRTH"}, isWholeBirth); }},
    {"payloads-alias-data-cmd-requirement", areDataKnown},
    {"payloads-name-birth-data-requirement",
     [] { return areEach({"NBIRTH", "DBIRTH", "DDATA"}, areMetricsTimed); }},
    {"payloads-metric-timestamp-in-UTC",
     [] { return areEach({"NBIRTH", "DBIRTH", "DDATA"}, areMetricsTimed); }},
    {"payloads-metric-datatype-value-type", [] { return areEach({"NBIRTH", "DBIRTH"}, isWholeBirth); }},
    {"payloads-metric-datatype-value", [] { return areEach({"NBIRTH", "DBIRTH"}, isWholeBirth); }},
    {"payloads-metric-datatype-req", [] { return areEach({"NBIRTH", "DBIRTH"}, isWholeBirth); }},
    {"payloads-metric-datatype-not-req", [] { return isEach("DDATA", areTypesAbsent); }},
    {"payloads-propertyset-keys-array-size", areUnitsProperties},
    {"payloads-propertyset-values-array-size", areUnitsProperties},
    {"payloads-metric-propertyvalue-type-req", areUnitsProperties},
    {"payloads-nbirth-timestamp", [] { return isEach("NBIRTH", hasTime); }},
    {"payloads-nbirth-seq", isSeqZero},
    {"payloads-nbirth-bdseq", areDeathsMatching},
    {"payloads-nbirth-bdseq-repeat", isRebirthComplete},
    {"payloads-nbirth-bdseq-inc", [] { return isCounted() && isCountedInARing(); }},
    {"payloads-nbirth-rebirth-req", [] { return isEach("NBIRTH", hasRebirth); }},
    {"payloads-nbirth-qos", [] { return isEach("NBIRTH", isPlain); }},
    {"payloads-nbirth-retain", [] { return isEach("NBIRTH", isPlain); }},
    {"payloads-dbirth-timestamp", [] { return isEach("DBIRTH", hasTime); }},
    {"payloads-dbirth-seq", [] { return hasSeq("DBIRTH"); }},
    {"payloads-dbirth-seq-inc", [] { return areNumbersConsecutive("DBIRTH"); }},
    {"payloads-dbirth-order", areBirthsFirst},
    {"payloads-dbirth-qos", [] { return isEach("DBIRTH", isPlain); }},
    {"payloads-dbirth-retain", [] { return isEach("DBIRTH", isPlain); }},
    {"payloads-ndata-timestamp", isNodeDataRight},
    {"payloads-ndata-seq", isNodeDataRight},
    {"payloads-ndata-order", isNoDataBeforeBirth},
    {"payloads-ndata-qos", isNodeDataRight},
    {"payloads-ndata-retain", isNodeDataRight},
    {"payloads-ddata-timestamp", [] { return isEach("DDATA", hasTime); }},
    {"payloads-ddata-seq", [] { return hasSeq("DDATA"); }},
    {"payloads-ddata-seq-inc", [] { return areNumbersConsecutive("DDATA"); }},
    {"payloads-ddata-order", isNoDataBeforeBirth},
    {"payloads-ddata-qos", [] { return isEach("DDATA", isPlain); }},
    {"payloads-ddata-retain", [] { return isEach("DDATA", isPlain); }},
    {"payloads-ndeath-seq", isDeathWithoutSeq},
    {"payloads-ndeath-will-message", [] { return isWill(isBdSeqAlone); }},
    {"payloads-ndeath-will-message-qos", isWillPlain},
    {"payloads-ndeath-will-message-retain", isWillPlain},
    {"payloads-ndeath-bdseq", areDeathsMatching},
    {"payloads-ndeath-will-message-publisher", isEndOrderly},
    {"payloads-ddeath-timestamp", [] { return isEach("DDEATH", hasTime); }},
    {"payloads-ddeath-seq", [] { return hasSeq("DDEATH"); }},
    {"payloads-ddeath-seq-inc", [] { return areNumbersConsecutive("DDEATH"); }},
    {"payloads-ddeath-seq-number", [] { return hasSeq("DDEATH"); }},
    {"is-historical", isHistoryMarked},
};

std::span<const Assertion> assertions() {
    return ALL;
}

class EdgeNodeAssertion : public ::testing::TestWithParam<std::size_t> {};

TEST_P(EdgeNodeAssertion, Holds) {
    const Assertion &assertion = assertions()[GetParam()];
    EXPECT_TRUE(assertion.holds()) << assertion.id;
}

std::string test_name(const ::testing::TestParamInfo<std::size_t> &info) {
    std::string name = assertions()[info.param].id;
    std::ranges::replace(name, '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Sparkplug, EdgeNodeAssertion, ::testing::Range<std::size_t>(0, assertions().size()),
                         test_name);

TEST(EdgeNodeAssertions, HaveEachIdentifierOnce) {
    std::set<std::string> ids;
    for (const Assertion &one : assertions()) {
        EXPECT_TRUE(ids.insert(one.id).second) << one.id;
    }
}

}  // namespace
}  // namespace mw::publish
