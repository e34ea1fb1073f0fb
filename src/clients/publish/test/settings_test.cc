// SPDX-License-Identifier: GPL-2.0-or-later
// Tests section [PUBLISH]: its settings, and the reported problems with line and column.
#include <fstream>
#include <regex>

#include "base/atomic_file.hh"
#include "clients/publish/assembly/ini_keys.hh"
#include "clients/publish/assembly/settings.hh"
#include "clients/publish/test/node_world.hh"

namespace mw::publish {
namespace {

const Surroundings AROUND{.host = "pc7", .machine_id = "id", .state_folder = "/state"};

struct Read {
    std::optional<Settings> settings;
    std::string messages;
};
Read read(const std::string &text, const Surroundings &around = AROUND) {
    Read found;
    diagnostics::Sink sink(
        [&found](const diagnostics::Diagnostic &one) { found.messages += one.what.str() + '\n'; });
    const auto file = ini::IniFile::parse(text, "m.ini", sink);
    found.settings = read_settings(file, around, sink);
    return found;
}

TEST(PublishSettings, HaveDefaults) {
    const Read found = read("[EMC]\nMACHINE = My Mill\n[PUBLISH]\nBROKER = broker.lan\n");
    ASSERT_TRUE(found.settings.has_value()) << found.messages;
    const Settings &settings = *found.settings;
    EXPECT_EQ(found.messages, "");
    EXPECT_EQ(settings.node.group, "millwright");
    EXPECT_EQ(settings.node.node, "pc7");
    EXPECT_EQ(settings.node.device, "My Mill");
    EXPECT_EQ(settings.link->brokers[0].host, "broker.lan");
    EXPECT_EQ(settings.link->brokers[0].port, 1883);
    EXPECT_EQ(settings.store, "/state/millwright/publish/My Mill");
    EXPECT_FALSE(settings.agent_port.has_value());
    EXPECT_EQ(settings.agent.uuid, "id.My Mill");
}

TEST(PublishSettings, ReadBrokersAndPorts) {
    const Read found = read(
        "[PUBLISH]\nBROKER = a:1\nBROKER = [::1]:2\nBROKER = [fe80::1]\nTLS = yes\nMTCONNECT_PORT = 5000\n"
        "DEADBAND = Axes/#/Position 0.25\n");
    ASSERT_TRUE(found.settings.has_value()) << found.messages;
    const auto &brokers = found.settings->link->brokers;
    ASSERT_EQ(brokers.size(), 3U);
    EXPECT_EQ(brokers[0].port, 1);
    EXPECT_EQ(brokers[1].host, "::1");
    EXPECT_EQ(brokers[1].port, 2);
    EXPECT_EQ(brokers[2].host, "fe80::1");
    EXPECT_EQ(brokers[2].port, 8883);
    EXPECT_EQ(found.settings->node.brokers, 3U);
    EXPECT_EQ(found.settings->agent_port->port, 5000);
    EXPECT_EQ(found.settings->deadbands.at("Axes/#/Position"), 0.25);
}

TEST(PublishSettings, ReportWhatIsWrongWithItsPlace) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"BROKER = a:0", "m.ini:2:10: 'a:0' is not HOST:PORT."},
        {"BROKER = a:70000", "m.ini:2:10: 'a:70000' is not HOST:PORT."},
        {"BROKER = a b", "m.ini:2:10: 'a b' is not HOST:PORT."},
        {"BROKER = a\nGROUP = x/y",
         "m.ini:3:9: [PUBLISH]GROUP = 'x/y' cannot be part of a topic: '/' is reserved"},
        {"BROKER = a\nNODE = +", "m.ini:3:8: [PUBLISH]NODE"},
        {"BROKER = a\nDEVICE = #1", "m.ini:3:10: [PUBLISH]DEVICE"},
        {"BROKER = a\nINTERVAL = 0", "m.ini:3:12: "},
        {"BROKER = a\nINTERVAL = soon", "m.ini:3:12: "},
        {"BROKER = a\nSTORE_SIZE = 0", "m.ini:3:14: "},
        {"BROKER = a\nTLS = perhaps", "m.ini:3:7: "},
        {"BROKER = a\nDEADBAND = Axes/#/Position", "m.ini:3:12: DEADBAND needs"},
        {"BROKER = a\nDEADBAND = Axes/#/Position -1", "m.ini:3:12: DEADBAND needs"},
        {"BROKER = a\nDEADBAND = Axes/#/Positon 1",
         "m.ini:3:12: No metric has the name 'Axes/#/Positon'. (Axes/#/Position)"},
        {"BROKER = a\nTLS = yes\nCA_FILE = none.pem", "m.ini:4:11: [PUBLISH]CA_FILE: cannot read"},
        {"BROKER = a\nPASSWORD_FILE = none", "m.ini:3:17: [PUBLISH]PASSWORD_FILE: cannot read"},
        {"MTCONNECT_PORT = 70000", "m.ini:2:18: "},
        {"GROUP = a", "m.ini:1:1: Nothing to publish"},
    };
    for (const auto &[text, expected] : cases) {
        const Read found = read("[PUBLISH]\n" + text + "\n");
        EXPECT_FALSE(found.settings.has_value()) << text;
        EXPECT_NE(found.messages.find(expected), std::string::npos) << text << " gives " << found.messages;
    }
    EXPECT_FALSE(read("[EMC]\n").settings.has_value());
}

TEST(PublishSettings, AreAllInTheBook) {
    const auto page = read_file(MW_SOURCE_DIR "/docs/integrator/shop.md");
    ASSERT_TRUE(page.has_value());
    for (const ini::IniKey &key : PUBLISH_KEYS) {
        const std::regex row("\\n\\|[^|]*\\b" + std::string(key.name) + "\\b[^|]*\\|");
        EXPECT_TRUE(std::regex_search(*page, row)) << key.name;
    }
}

TEST(PublishSettings, WarnOfAnUnknownKey) {
    const Read found = read("[PUBLISH]\nBROKER = a\nBROCKER = b\n");
    EXPECT_TRUE(found.settings.has_value());
    EXPECT_NE(found.messages.find("m.ini:3:"), std::string::npos) << found.messages;
}

TEST(PublishSettings, ProtectThePassword) {
    const OwnFolder folder;
    const std::string path = folder.path() + "/password";
    std::ofstream(path) << "secret\n";
    ::chmod(path.c_str(), 0644);
    const std::string text = "[PUBLISH]\nBROKER = a\nUSER = mill\nPASSWORD_FILE = " + path + "\n";
    EXPECT_NE(read(text).messages.find("Other users can read the password"), std::string::npos);
    ::chmod(path.c_str(), 0600);
    const Read found = read(text);
    ASSERT_TRUE(found.settings.has_value()) << found.messages;
    EXPECT_EQ(found.settings->link->password, "secret");
    EXPECT_FALSE(read("[PUBLISH]\nBROKER = a\nPASSWORD_FILE = " + path + "\n").settings.has_value())
        << "without USER";
}

TEST(PublishSettings, NeedCertificatesInPairsAndTls) {
    const OwnFolder folder;
    const std::string path = folder.path() + "/x.pem";
    std::ofstream(path) << "x";
    EXPECT_FALSE(read("[PUBLISH]\nBROKER = a\nTLS = yes\nCERTIFICATE = " + path + "\n").settings.has_value());
    EXPECT_FALSE(read("[PUBLISH]\nBROKER = a\nCA_FILE = " + path + "\n").settings.has_value());
    EXPECT_TRUE(read("[PUBLISH]\nBROKER = a\nTLS = yes\nCA_FILE = " + path + "\n").settings.has_value());
}

}  // namespace
}  // namespace mw::publish
