// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "drivers/mesa/ethernet/network_setup.hh"

namespace mw::mesa {
namespace {

TEST(BoardRoute, OfALoopbackAddressIsTheLoopbackInterface) {
    const auto route = find_route("127.0.0.1");
    ASSERT_TRUE(route.has_value()) << route.error().str();
    EXPECT_EQ(route->interface, "lo");
    EXPECT_EQ(route->own_address, "127.0.0.1");
    EXPECT_TRUE(route->loopback);
    EXPECT_FALSE(route->has_default_route);
}

TEST(BoardRoute, AnAddressThatIsNoneIsNamed) {
    const auto route = find_route("board");
    ASSERT_FALSE(route.has_value());
    EXPECT_NE(route.error().message.find("'board'"), std::string::npos);
}

TEST(BoardFirewall, LetsOnlyTheBoardsPass) {
    const std::string rules =
        firewall_rules({.interface = "eth1", .own_address = "192.168.1.1"},
                       {{.ip = "192.168.1.121"}, {.ip = "192.168.1.122", .port = 27182}});
    const std::size_t first = rules.find("oifname \"eth1\" ip daddr 192.168.1.121 udp dport 27181 accept");
    const std::size_t second = rules.find("oifname \"eth1\" ip daddr 192.168.1.122 udp dport 27182 accept");
    const std::size_t others = rules.find("oifname \"eth1\" drop");
    EXPECT_LT(first, second);
    EXPECT_LT(second, others);
    EXPECT_NE(others, std::string::npos);
}

TEST(BoardFirewall, LeavesTheInterfaceOfOtherTrafficOpen) {
    const auto firewall =
        BoardFirewall::create({.interface = "eth0", .own_address = "192.168.1.1", .has_default_route = true},
                              {{.ip = "192.168.1.121"}});
    ASSERT_FALSE(firewall.has_value());
    EXPECT_NE(firewall.error().message.find("default route"), std::string::npos);
    EXPECT_FALSE(BoardFirewall::create({.interface = "lo", .own_address = "127.0.0.1", .loopback = true},
                                       {{.ip = "127.0.0.1"}})
                     .has_value());
}

}  // namespace
}  // namespace mw::mesa
