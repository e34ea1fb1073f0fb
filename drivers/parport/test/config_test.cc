// SPDX-License-Identifier: GPL-2.0-or-later
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/parport/config.hh"

namespace mw::parport {
namespace {

std::vector<PortConfig> ports_of(const char *text) {
    const Config config = read_config(text);
    EXPECT_EQ(config.problem, nullptr) << text << ": " << config.token.data();
    return {config.port.begin(), config.port.begin() + config.count};
}

std::string problem_of(const char *text) {
    const Config config = read_config(text);
    return std::string(config.token.data()) + ": " + (config.problem == nullptr ? "" : config.problem);
}

TEST(ParportConfig, HasAddressesWithTheirTypes) {
    EXPECT_EQ(ports_of("0x378 out 0x278 in"),
              (std::vector<PortConfig>{{0x378, Mode::OUT}, {0x278, Mode::IN}}));
    EXPECT_EQ(ports_of("0x378_x_0x278_epp"),
              (std::vector<PortConfig>{{0x378, Mode::CONTROL_IN}, {0x278, Mode::EPP}}));
    EXPECT_EQ(ports_of("0 1 i"), (std::vector<PortConfig>{{0, Mode::OUT}, {1, Mode::IN}}));
    EXPECT_EQ(ports_of("  888  OUT "), (std::vector<PortConfig>{{888, Mode::OUT}}));
}

TEST(ParportConfig, NamesTheWordThatIsWrong) {
    EXPECT_EQ(problem_of("0x378 both"), "both: is no type of a port: out, in, x and epp are possible");
    EXPECT_EQ(problem_of("out"), "out: must follow the address of a port");
    EXPECT_EQ(problem_of("0x378 out in"), "in: must follow the address of a port");
    EXPECT_EQ(problem_of("0x3z8"),
              "0x3z8: is no address of a port, such as 0x378, and no number of a port, such as 0");
    EXPECT_EQ(problem_of("0x12345"), "0x12345: is outside the addresses of ports, 0x10 to 0xfff8");
    EXPECT_EQ(problem_of("0x378 0x378"), "0x378: occurs twice");
    EXPECT_EQ(problem_of("0 1 2 3 4 5 6 7 8"), "8: eight ports are possible");
    EXPECT_EQ(problem_of(""), ": no port is given, such as cfg=\"0x378 out\"");
    EXPECT_NE(problem_of(std::string(1000, '1').c_str()).find("too long"), std::string::npos);
}

}  // namespace
}  // namespace mw::parport
