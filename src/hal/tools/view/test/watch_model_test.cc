// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/test/bench.hh"
#include "hal/tools/view/watch_model.hh"

namespace mw::hal::view {
namespace {

using components::test::Bench;

constexpr const char *MACHINE = "loadrt and2 count=2\nloadrt siggen\naddf and2.0 t\naddf siggen.0.update t\n"
                                "net gate and2.0.out => and2.1.in0\n";

struct Viewer {
    explicit Viewer(Bench &bench) : model(bench.hal()) { model.refresh(); }
    void press(Key key) {
        model.press(key);
        model.refresh();
    }
    void type(const std::string &text) {
        model.type(text);
        model.refresh();
    }
    void go_to(const std::string &name) {
        press(Key::HOME);
        while (row().name != name && model.cursor() + 1 < model.rows().size()) {
            press(Key::DOWN);
        }
        ASSERT_EQ(row().name, name);
    }
    const WatchRow &row() const { return model.rows()[model.cursor()]; }
    std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const WatchRow &r : model.rows()) {
            all.push_back(r.name);
        }
        return all;
    }
    WatchModel model;
};

TEST(WatchModel, PinsAreATreeByDots) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    for (const WatchRow &row : viewer.model.rows()) {
        EXPECT_TRUE(row.is_branch) << row.name;
        EXPECT_EQ(row.depth, 0);
    }
    viewer.go_to("and2");
    viewer.press(Key::OPEN);
    viewer.go_to("and2.0");
    viewer.press(Key::ENTER);
    viewer.go_to("and2.0.out");
    EXPECT_EQ(viewer.row().label, "out");
    EXPECT_EQ(viewer.row().depth, 2);
    EXPECT_EQ(viewer.row().extra, "==> gate");
    viewer.press(Key::CLOSE);  // moves to the branch
    EXPECT_EQ(viewer.row().name, "and2.0");
    viewer.press(Key::CLOSE);
    EXPECT_FALSE(viewer.row().isOpen);
}

TEST(WatchModel, FilterOpensWhatItFinds) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    viewer.press(Key::FILTER);
    viewer.type("in1x");
    viewer.press(Key::ERASE);
    viewer.press(Key::ENTER);
    EXPECT_EQ(viewer.names(),
              (std::vector<std::string>{"and2", "and2.0", "and2.0.in1", "and2.1", "and2.1.in1"}));
    viewer.press(Key::ESCAPE);
    EXPECT_TRUE(viewer.model.filter().empty());
}

TEST(WatchModel, SetsValuesOrSaysWhyNot) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    viewer.press(Key::FILTER);
    viewer.type("and2.0.");
    viewer.press(Key::ENTER);
    viewer.go_to("and2.0.in0");
    viewer.press(Key::SET);
    viewer.type("true");
    viewer.press(Key::ENTER);
    EXPECT_EQ(bench.get("and2.0.in0"), 1.0);
    viewer.go_to("and2.0.out");
    viewer.press(Key::SET);
    viewer.type("true");
    viewer.press(Key::ENTER);
    EXPECT_NE(viewer.model.status().find("and2.0.out"), std::string::npos);
    EXPECT_EQ(bench.get("and2.0.out"), 0.0);
}

TEST(WatchModel, WatchListKeepsNamesInTheirOrder) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    viewer.model.watch("siggen.0.frequency");
    viewer.model.watch("gate");
    viewer.model.watch("no.such");
    viewer.model.open_page(Page::WATCH);
    viewer.model.refresh();
    EXPECT_EQ(viewer.names(), (std::vector<std::string>{"siggen.0.frequency", "gate", "no.such"}));
    EXPECT_EQ(viewer.model.rows()[2].value, "gone");
    viewer.press(Key::WATCH);
    EXPECT_EQ(viewer.names().size(), 2U);
}

TEST(WatchModel, ThreadsShowTheirFunctions) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    viewer.press(Key::NEXT_PAGE);
    EXPECT_EQ(viewer.names(), (std::vector<std::string>{"gate"}));
    EXPECT_EQ(viewer.row().extra, "and2.0.out ==> and2.1.in0");
    viewer.press(Key::NEXT_PAGE);
    EXPECT_EQ(viewer.names(), (std::vector<std::string>{"t", "and2.0", "siggen.0.update"}));
    EXPECT_EQ(viewer.row().value, "1000.0 us");
}

TEST(WatchModel, CursorStaysOnTheScreen) {
    Bench bench(MACHINE);
    Viewer viewer(bench);
    viewer.model.set_height(3);
    viewer.press(Key::FILTER);
    viewer.type(".");
    viewer.press(Key::ENTER);
    for (const Key key : {Key::END, Key::UP, Key::PAGE_UP, Key::DOWN, Key::HOME, Key::PAGE_DOWN, Key::UP}) {
        viewer.press(key);
        EXPECT_GE(viewer.model.cursor(), viewer.model.top());
        EXPECT_LT(viewer.model.cursor(), viewer.model.top() + 3);
    }
    viewer.press(Key::QUIT);
    EXPECT_TRUE(viewer.model.isDone());
}

TEST(WatchModel, RowsAreCutToTheScreen) {
    const WatchRow row{1, "out", "and2.0.out", false, false, "bit OUT", "TRUE", "==> gate"};
    EXPECT_EQ(row_text(row, 10).size(), 10U);
    EXPECT_NE(row_text(row, 200).find("TRUE  bit OUT"), std::string::npos);
}

}  // namespace
}  // namespace mw::hal::view
