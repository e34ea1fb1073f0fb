// SPDX-License-Identifier: GPL-2.0-or-later
#include <filesystem>

#include "base/atomic_file.hh"
#include "components/test/bench.hh"
#include "hal/tools/view/netlist.hh"

namespace mw::hal::view {
namespace {

using components::test::Bench;

constexpr const char *NETS = "loadrt and2 count=2\nloadrt not\naddf and2.0 t\n"
                             "net first and2.0.out => and2.1.in0 not.0.in\n"
                             "net lonely => and2.1.in1\nsets lonely 1\n";

TEST(Netlist, DrawsAnEdgeFromWriterToEachReader) {
    Bench bench(NETS);
    const std::string dot = netlist_dot(bench.hal(), {});
    EXPECT_NE(dot.find("\"and2.0\":\"and2.0.out\" -> \"and2.1\":\"and2.1.in0\" [label=\"first\""),
              std::string::npos);
    EXPECT_NE(dot.find("\"and2.0\":\"and2.0.out\" -> \"not.0\":\"not.0.in\""), std::string::npos);
    EXPECT_NE(dot.find("\"signal lonely\" -> \"and2.1\":\"and2.1.in1\""), std::string::npos);
    EXPECT_EQ(dot.find("and2.0.in1"), std::string::npos);
}

TEST(Netlist, ShowsValuesUnlinkedPinsAndParts) {
    Bench bench(NETS);
    EXPECT_NE(netlist_dot(bench.hal(), {"*", true, true}).find("lonely = TRUE"), std::string::npos);
    EXPECT_NE(netlist_dot(bench.hal(), {"*", true, false}).find("and2.0.in1"), std::string::npos);
    const std::string part = netlist_dot(bench.hal(), {"not.0"});
    EXPECT_NE(part.find("not.0.in"), std::string::npos);
    EXPECT_NE(part.find("and2.0.out"), std::string::npos);
    EXPECT_EQ(part.find("lonely"), std::string::npos);
}

TEST(Netlist, EndingsSayTheFormat) {
    Bench bench(NETS);
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("net" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    ASSERT_TRUE(write_netlist(bench.hal(), {}, folder / "a.dot"));
    // A file of the user with a similar name is kept.
    ASSERT_TRUE(write_file_atomically(folder / "a.svg.dot", "mine"));
    const Result<> drawn = write_netlist(bench.hal(), {}, folder / "a.svg");
    ASSERT_TRUE(drawn) << drawn.error().str();
    EXPECT_NE(read_file(folder / "a.svg").value_or("").find("and2.1"), std::string::npos);
    EXPECT_EQ(read_file(folder / "a.svg.dot").value_or(""), "mine");
    EXPECT_FALSE(write_netlist(bench.hal(), {}, folder / "a.txt"));
    EXPECT_FALSE(write_netlist(bench.hal(), {}, folder / "no" / "a.svg"));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace mw::hal::view
