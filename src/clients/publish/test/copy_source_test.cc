// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the copies of files of a machine for the shop.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "clients/publish/offers/offer_session.hh"
#include "clients/publish/test/node_world.hh"

namespace mw::publish {
namespace {

TEST(CopySource, ReadsAChangedFileAtMostOncePerPeriod) {
    const OwnFolder folder;
    const std::string path = folder.path() + "/tool.tbl";
    CopySource source({{"tools", path}}, 60);
    EXPECT_TRUE(source.look(0).empty()) << "there is no file";
    EXPECT_EQ(source.find("tools"), nullptr);
    std::ofstream(path) << "T1 P1\n";
    ASSERT_EQ(source.look(1).size(), 1);
    EXPECT_EQ(source.find("tools")->bytes, "T1 P1\n");
    EXPECT_EQ(source.find("tools")->name, "tool.tbl");
    std::ofstream(path) << "T1 P1 D5 Z1\n";
    EXPECT_EQ(source.look(30)[0].sha256, offers::sha256_of_bytes("T1 P1\n"));
    EXPECT_EQ(source.look(62)[0].sha256, offers::sha256_of_bytes("T1 P1 D5 Z1\n"));
    std::filesystem::remove(path);
    EXPECT_TRUE(source.look(200).empty());
}

TEST(CopySource, LeavesOutAFileThatIsTooLarge) {
    const OwnFolder folder;
    const std::string path = folder.path() + "/tool.tbl";
    std::ofstream(path) << std::string(offers::MOST_COPY_BYTES + 1, 'x');
    CopySource source({{"tools", path}, {"other", folder.path()}}, 60);
    EXPECT_TRUE(source.look(0).empty());
}

TEST(OfferSession, SendsACopyThatTheShopWants) {
    const OwnFolder folder;
    const std::string path = folder.path() + "/tool.tbl", bytes("T1 P1 ;\xff\0\n", 11);
    std::ofstream(path) << bytes;
    auto box = offers::OfferBox::open(folder.path() + "/offers").value();
    PlayedBroker broker;
    OfferSession session(
        {.host = "shop", .group = "g", .node = "n", .device = "d", .copies = {{"tools", path}}}, box, broker,
        [](const std::string &) {});
    auto step = [&session, now_s = 100.0]() mutable {
        now_s += 0.1;
        session.step({1, now_s});
    };
    step();
    step();
    const auto report = offers::decode_report(broker.packets.back().message.payload).value();
    ASSERT_EQ(report.copies.size(), 1);
    for (const char *reply : {R"({"noted":[],"withdrawn":[],"wanted":["tools"]})",
                              R"({"noted":[],"withdrawn":[],"wanted":["../etc/passwd"]})"}) {
        broker.events.emplace_back(Publication{"", reply, 1, false});
        step();
    }
    const Publication sent = broker.packets.back().message;
    EXPECT_EQ(sent.topic, "millwright/copy/shop/g/n/d");
    EXPECT_EQ(offers::decode_copy(sent.payload).value(), (offers::Copy{report.copies[0], "tool.tbl", bytes}));
}

}  // namespace
}  // namespace mw::publish
