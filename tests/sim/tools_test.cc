// SPDX-License-Identifier: GPL-2.0-or-later
// Random tool commands, faults, aborts and restarts, compared with a model of both types of changer. The
// displays of the machine, its file and the parameters of programs must agree with the model after each.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "sim/machine_file.hh"

namespace mw::machine {
namespace {

/// Expected content of the magazine and the spindle.
struct Paper {
    struct Tool {
        int pocket = 0;
        double z = 0, diameter = 0;
    };
    bool isRandom = false;
    std::map<int, Tool> tools;  ///< by number
    int spindle = 0;            ///< -1: empty, of a random changer
    int from = 0;               ///< pocket
    double offset_z = 0;        ///< active

    bool has(int number) const { return tools.contains(number); }
    int in_pocket(int pocket) const {
        for (const auto &[number, tool] : tools) {
            if (tool.pocket == pocket) {
                return number;
            }
        }
        return -1;
    }
    /// The manual tool change: `number` is put into the spindle.
    void load(int number) {
        if (isRandom) {
            const int pocket = tools[number].pocket;
            if (pocket != 0 && spindle >= 0) {
                tools[spindle].pocket = pocket;
            }
            tools[number].pocket = 0;
        }
        spindle = number;
    }
    double z() const { return has(spindle) && (spindle > 0 || isRandom) ? tools.at(spindle).z : 0; }
    /// Pocket of a new tool without a pocket.
    int free_pocket(int number) const {
        int pocket = number;
        for (int next = 1; in_pocket(pocket) >= 0; ++next) {
            pocket = next;
        }
        return pocket;
    }
    double diameter() const {
        return has(spindle) && (spindle > 0 || isRandom) ? tools.at(spindle).diameter : 0;
    }
};

/// Counts of tested actions, so that a campaign without actions fails.
struct Tried {
    int changes = 0, same = 0, faults = 0, aborts = 0, refused = 0, entries = 0, restarts = 0, named = 0,
        added = 0, removed = 0;
};

class ToolJudge : public ::testing::Test {
  protected:
    ToolJudge()
        : folder_(std::filesystem::temp_directory_path() / ("mw_tools_" + std::to_string(::getpid()))) {
        std::filesystem::create_directory(folder_);
    }
    ~ToolJudge() override {
        machine_.reset();
        std::filesystem::remove_all(folder_);
    }
    void write(const std::string &name, const std::string &text) const {
        std::ofstream(folder_ / name) << text;
    }
    std::string read(const std::string &name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }
    client::Serial post(const messages::Command &command) {
        const auto posted = machine_->client().post(command);
        EXPECT_TRUE(posted.has_value());
        return posted.value_or(0);
    }
    messages::Progress progress(client::Serial command) const {
        return machine_->client().outcome(command).progress;
    }
    void cycles(int n) {
        for (int i = 0; i < n; ++i) {
            machine_->cycle();
        }
    }
    client::Serial ask(const messages::Command &command) {
        const auto id = post(command);
        for (int i = 0; i < 20000 && (i < 3 || progress(id) == messages::Progress::STARTED); ++i) {
            cycles(1);
        }
        return id;
    }
    bool pin(const std::string &name) const { return machine_->hal().values().get(name)->as_bit(); }
    void set_pin(const std::string &name, const std::string &value) {
        ASSERT_TRUE(machine_->hal().values().set(name, value).has_value());
    }
    std::string messages() {
        std::string all;
        while (const auto message = machine_->client().next_message()) {
            all += message->text + '\n';
        }
        return all;
    }
    void begin(bool isRandom, unsigned seed) {
        random_.seed(seed);
        paper_ = {};
        paper_.isRandom = isRandom;
        paper_.tools = {{5, {3, 10, 6}}, {7, {4, 20, 8}}, {9, {11, 30, 10}}, {12, {2, 0, 0}}};
        if (isRandom) {
            paper_.tools[0] = {0, 0, 0};
        }
        SimMachine machine;
        ini_ = machine.write(folder_);
        std::string hal = read("sim.hal"), ini = read("sim.ini");
        for (const char *line : {"net prepared iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n",
                                 "net changed iocontrol.0.tool-change => iocontrol.0.tool-changed\n"}) {
            hal.erase(hal.find(line), std::string(line).size());
        }
        const std::string key = "TOOL_TABLE = sim.tbl\n";
        ini.insert(ini.find(key) + key.size(), fmt::format("RANDOM_TOOLCHANGER = {}\n", isRandom ? 1 : 0));
        write("sim.hal", hal);
        write("sim.ini", ini);
        std::string table = "; the tools of the judge\n";
        for (const auto &[number, tool] : paper_.tools) {
            table +=
                fmt::format("T{} P{} Z{} D{} ;tool {}\n", number, tool.pocket, tool.z, tool.diameter, number);
        }
        write("sim.tbl", table);
        restart();
    }
    void restart() {
        machine_.reset();
        loaded_ = LoadedConfig::load(ini_, sink_);
        ASSERT_NE(loaded_, nullptr) << (sink_.all().empty() ? "" : sink_.all().back().str());
        loaded_->machine.task.parameter_file.clear();
        auto made =
            make_virtual_machine({loaded_->ini, loaded_->reader, loaded_->machine, sink_}, MachineOptions{});
        ASSERT_TRUE(made.has_value()) << made.error().str();
        machine_ = std::move(*made);
        for (const messages::Command &command :
             {messages::Command(messages::SetState{messages::State::ESTOP_RESET}),
              messages::Command(messages::SetState{messages::State::ON}),
              messages::Command(messages::HomeJoint{-1}),
              messages::Command(messages::SetMode{messages::Mode::MDI})}) {
            ASSERT_EQ(progress(ask(command)), messages::Progress::DONE) << messages();
        }
        paper_.spindle = paper_.isRandom ? paper_.in_pocket(0) : 0;
        paper_.from = 0;
        paper_.offset_z = 0;
        left_ = -1;
    }
    int any(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
    int any_tool() {
        constexpr int NUMBERS[] = {0, 5, 7, 9, 12, 77};
        return NUMBERS[any(0, 5)];
    }
    bool isLoadable(int number) const { return paper_.has(number) || (number == 0 && !paper_.isRandom); }

    /// Executes one line while the changer works, which may fail or be stopped in a random cycle.
    messages::Progress run(const std::string &line, int fault_at = -1, int abort_at = -1) {
        run_ = post(messages::Mdi{line});
        int delay = any(0, 6);
        for (int i = 0; i < 3000 && progress(run_) == messages::Progress::STARTED; ++i) {
            if (i == abort_at) {
                post(messages::AbortAll{});
            }
            set_pin("iocontrol.0.toolchanger-fault", i == fault_at ? "1" : "0");
            set_pin("iocontrol.0.tool-prepared", pin("iocontrol.0.tool-prepare") ? "1" : "0");
            const bool isAsked = pin("iocontrol.0.tool-change");
            const bool isFaulted = i == fault_at;
            if (isAsked && !isFaulted && !pin("iocontrol.0.tool-changed") && delay-- <= 0) {
                isSwapped_ = true;
                set_pin("iocontrol.0.tool-changed", "1");
            } else if (!isAsked) {
                set_pin("iocontrol.0.tool-changed", "0");
            }
            cycles(1);
        }
        set_pin("iocontrol.0.toolchanger-fault", "0");
        for (int i = 0; i < 5; ++i) {
            set_pin("iocontrol.0.tool-prepared", "0");
            set_pin("iocontrol.0.tool-changed", "0");
            cycles(1);
        }
        return progress(run_);
    }

    void change() {
        const int number = any_tool();
        const bool isFault = any(0, 5) == 0, isAbort = !isFault && any(0, 4) == 0;
        const int at = any(0, 14);
        isSwapped_ = false;
        const int was = paper_.spindle;
        const messages::Progress ended =
            run(fmt::format("T{} M6", number), isFault ? at : -1, isAbort ? at : -1);
        if (isLoadable(number)) {
            left_ = isSwapped_ && ended == messages::Progress::DONE ? -1 : number;
        }
        if (!isLoadable(number)) {
            EXPECT_NE(ended, messages::Progress::DONE) << number;
            ++tried_.refused;
        } else if (isSwapped_) {
            paper_.from = number == 0 ? 0 : paper_.tools[number].pocket;
            paper_.load(number);
            ++tried_.changes;
        } else if (ended == messages::Progress::DONE) {
            EXPECT_EQ(number, was) << "nothing was changed";
            ++tried_.same;
        }
        tried_.faults += isFault && ended != messages::Progress::DONE ? 1 : 0;
        tried_.aborts += isAbort && ended != messages::Progress::DONE ? 1 : 0;
    }
    void name() {
        const int number = any_tool();
        const messages::Progress ended = run(fmt::format("M61 Q{}", number));
        EXPECT_EQ(ended == messages::Progress::DONE, isLoadable(number)) << number;
        if (!isLoadable(number)) {
            ++tried_.refused;
            return;
        }
        paper_.load(number);
        paper_.from = number == 0 ? 0 : paper_.from;
        ++tried_.named;
    }
    void set_entry() {
        const int number = any_tool();
        const double z = any(-400, 400) / 8.0, radius = any(0, 80) / 8.0;
        bool isDone = false;
        const int way = any(0, 2);
        switch (way) {
        case 0:
            isDone = run(fmt::format("G10 L1 P{} Z{} R{}", number, z, radius)) == messages::Progress::DONE;
            break;
        case 1:  // the machine is at Z0: with the new offset the position is -z
            isDone = run(fmt::format("G10 L10 P{} Z{} R{}", number, -z, radius)) == messages::Progress::DONE;
            break;
        default: {
            messages::SetToolEntry order;
            order.toolno = number;
            order.offset[2] = z;
            order.diameter = 2 * radius;
            isDone = progress(ask(order)) == messages::Progress::DONE;
            break;
        }
        }
        const bool isAllowed = number > 0 || way == 2;  // G10 rejects T0, also on a random tool changer
        EXPECT_EQ(isDone, isAllowed && paper_.has(number)) << number;
        if (isDone) {
            paper_.tools[number].z = z;
            paper_.tools[number].diameter = 2 * radius;
            ++tried_.entries;
        } else {
            ++tried_.refused;
        }
    }
    void add() {
        constexpr int POCKETS[] = {0, 0, 3, 4, 50};
        messages::AddTool order;
        order.toolno = std::max(5, any_tool());
        order.pocket = POCKETS[any(0, 4)];
        order.offset[2] = any(-400, 400) / 8.0;
        order.diameter = any(0, 80) / 8.0;
        order.comment = fmt::format("tool {}", order.toolno);
        const bool isPocketTaken = order.pocket != 0 && paper_.in_pocket(order.pocket) >= 0;
        const bool isDone = progress(ask(order)) == messages::Progress::DONE;
        EXPECT_EQ(isDone, !paper_.has(order.toolno) && !isPocketTaken)
            << order.toolno << " P" << order.pocket;
        if (isDone) {
            const int pocket = order.pocket != 0 ? order.pocket : paper_.free_pocket(order.toolno);
            paper_.tools[order.toolno] = {pocket, order.offset[2], order.diameter};
            ++tried_.added;
        } else {
            ++tried_.refused;
        }
    }
    void remove() {
        const int number = any_tool();
        messages();
        const bool isDone = progress(ask(messages::RemoveTool{number})) == messages::Progress::DONE;
        const std::string told = messages();
        const bool isPrepared =
            number == left_ && told.find("is prepared for the next change") != std::string::npos;
        EXPECT_EQ(isDone, paper_.has(number) && paper_.spindle != number && !isPrepared)
            << number << ": " << told;
        if (isDone) {
            paper_.tools.erase(number);
            ++tried_.removed;
        } else {
            ++tried_.refused;
        }
    }
    void use_offset() {
        const bool isOff = any(0, 1) == 0;
        EXPECT_EQ(run(isOff ? "G49" : "G43"), messages::Progress::DONE);
        paper_.offset_z = isOff ? 0 : paper_.z();
    }
    void step(int kind) {
        switch (kind) {
        case 0:
        case 1:
        case 2: change(); break;
        case 3: name(); break;
        case 4:
        case 5: set_entry(); break;
        case 6: use_offset(); break;
        case 8:
        case 9: add(); break;
        case 10: remove(); break;
        case 7: EXPECT_EQ(progress(ask(messages::LoadToolTable{})), messages::Progress::DONE); break;
        default:
            restart();
            ++tried_.restarts;
            break;
        }
    }

    void compare() {
        cycles(2);
        ASSERT_TRUE(machine_->client().read_status().has_value());
        const messages::ToolStatus &shown = machine_->client().status().tool;
        EXPECT_EQ(shown.in_spindle, std::max(0, paper_.spindle));
        EXPECT_EQ(shown.from_pocket, paper_.from);
        EXPECT_EQ(machine_->hal().values().get("iocontrol.0.tool-number")->as_number(),
                  std::max(0, paper_.spindle));
        EXPECT_FALSE(pin("iocontrol.0.tool-change")) << "nothing continues by itself";
        EXPECT_FALSE(pin("iocontrol.0.tool-prepare"));
        compare_file();
        compare_parameters();
    }
    /// Read by an independent reader.
    void compare_file() {
        std::istringstream lines(read("sim.tbl"));
        std::map<int, Paper::Tool> found;
        bool hasComment = false;
        for (std::string line; std::getline(lines, line);) {
            hasComment = hasComment || line == "; the tools of the judge";
            int number = -1;
            Paper::Tool tool;
            if (std::sscanf(line.c_str(), "T%d P%d", &number, &tool.pocket) != 2) {
                continue;
            }
            const auto figure = [&line](char letter) {
                const std::size_t at = line.find(std::string(" ") + letter);
                return at == std::string::npos || at > line.find(';') ? 0.0
                                                                      : std::atof(line.c_str() + at + 2);
            };
            tool.z = figure('Z');
            tool.diameter = figure('D');
            found[number] = tool;
            EXPECT_NE(line.find(";tool " + std::to_string(number)), std::string::npos) << line;
        }
        EXPECT_TRUE(hasComment);
        ASSERT_EQ(found.size(), paper_.tools.size()) << read("sim.tbl");
        for (const auto &[number, tool] : paper_.tools) {
            EXPECT_EQ(found[number].pocket, tool.pocket) << "tool " << number;
            EXPECT_NEAR(found[number].z, tool.z, 1e-9) << "tool " << number;
            EXPECT_NEAR(found[number].diameter, tool.diameter, 1e-9) << "tool " << number;
        }
    }
    void compare_parameters() {
        messages();
        ASSERT_EQ(run("(DEBUG,is #5400 #5403 #5410)"), messages::Progress::DONE);
        double number = 0, z = 0, diameter = 0;
        const std::string said = messages();
        ASSERT_EQ(std::sscanf(said.c_str(), "is %lf %lf %lf", &number, &z, &diameter), 3) << said;
        EXPECT_EQ(number, std::max(0, paper_.spindle));
        EXPECT_NEAR(diameter, paper_.diameter(), 1e-6);
        EXPECT_NEAR(machine_->client().status().offsets.tool[2], paper_.offset_z, 1e-9);
    }

    void judge(bool isRandom, unsigned seed, int steps) {
        begin(isRandom, seed);
        std::string story;
        for (int i = 0; i < steps && !HasFailure(); ++i) {
            const int kind = any(0, 19) == 0 ? 11 : any(0, 10);
            step(kind);
            story += fmt::format(" {}", kind);
            SCOPED_TRACE(fmt::format("seed {} {} step {}:{}", seed, isRandom ? "random" : "fixed", i, story));
            compare();
        }
    }

    std::filesystem::path folder_;
    diagnostics::Sink sink_;
    std::unique_ptr<LoadedConfig> loaded_;
    std::unique_ptr<Machine> machine_;
    client::Serial run_ = 0;
    std::mt19937 random_;
    std::string ini_;
    Paper paper_;
    Tried tried_;
    int left_ = -1;  ///< tool of a change that was not confirmed: it may still be prepared
    bool isSwapped_ = false;
};

TEST_F(ToolJudge, BothKindsOfChangersAreAsOnPaper) {
    const char *more = std::getenv("MW_TOOL_SEEDS");
    const int seeds = more != nullptr ? std::atoi(more) : 6;
    for (unsigned seed = 1; seed <= static_cast<unsigned>(seeds) && !HasFailure(); ++seed) {
        judge(false, seed, 50);
        judge(true, seed, 50);
    }
    fmt::print("changes {} same {} faults {} aborts {} refused {} entries {} named {} restarts {} added {} "
               "removed {}\n",
               tried_.changes, tried_.same, tried_.faults, tried_.aborts, tried_.refused, tried_.entries,
               tried_.named, tried_.restarts, tried_.added, tried_.removed);
    EXPECT_GT(tried_.changes, 5 * seeds);
    EXPECT_GT(tried_.faults, seeds / 2);
    EXPECT_GT(tried_.aborts, seeds / 2);
    EXPECT_GT(tried_.refused, seeds);
    EXPECT_GT(tried_.entries, 3 * seeds);
    EXPECT_GT(tried_.restarts, seeds / 2);
    EXPECT_GT(tried_.added, 2 * seeds);
    EXPECT_GT(tried_.removed, 2 * seeds);
}

}  // namespace
}  // namespace mw::machine
