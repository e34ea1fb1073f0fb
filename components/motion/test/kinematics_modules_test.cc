// SPDX-License-Identifier: GPL-2.0-or-later
// Modules of kinematics as HAL sees them: pins with the initial values of LinuxCNC's modules, a manual page
// that names every pin, and a motion controller that loads on top of them.
#include <cctype>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::motion {
namespace {

struct Loaded {
    runtime::VirtualScheduler clock;
    std::unique_ptr<hal::LocalHost> host;

    Loaded() {
        hal::InstanceOptions options;
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options, {MW_MODULE_FOLDER});
        if (made.has_value()) {
            host = std::move(*made);
        }
    }
    std::string load(const std::string &name, const std::vector<std::string> &args = {}) {
        const auto status = host->load_realtime(name, args);
        return status.has_value() ? "ok" : status.error().str();
    }
    double value(const std::string &pin) { return host->hal().values().get(pin)->as_number(); }
};

struct Module {
    const char *name;
    int joints;
    std::vector<std::pair<const char *, double>> starts;
};

/// Measured on LinuxCNC 2.9: `loadrt NAME`, `show pin`, `show param`; matrixkins, three21kins, xyzacb_trsrn
/// and xyzbca_trsrn are of the version after it.
const std::vector<Module> MODULES = {
    {"rotatekins", 3, {}},
    {"scorbot-kins", 5, {}},
    {"tripodkins", 3, {{"tripodkins.Bx", 1}, {"tripodkins.Cx", 1}, {"tripodkins.Cy", 1}}},
    {"lineardeltakins", 3, {{"lineardeltakins.R", 130.25}, {"lineardeltakins.L", 269}}},
    {"rotarydeltakins",
     3,
     {{"rotarydeltakins.platformradius", 10},
      {"rotarydeltakins.thighlength", 10},
      {"rotarydeltakins.shinlength", 14},
      {"rotarydeltakins.footradius", 6}}},
    {"maxkins", 9, {{"maxkins.pivot-length", 0.666}}},
    {"matrixkins", 3, {{"matrixkins.C_xx", 1}, {"matrixkins.C_xy", 0}, {"matrixkins.C_zz", 1}}},
    {"5axiskins", 6, {{"5axiskins.pivot-length", 250}, {"kinstype.is-0", 1}, {"kinstype.is-1", 0}}},
    {"xyzac-trt-kins",
     5,
     {{"xyzac-trt-kins.x-rot-point", 0}, {"xyzac-trt-kins.y-offset", 0}, {"xyzac-trt-kins.tool-offset", 0}}},
    {"xyzbc-trt-kins",
     5,
     {{"xyzbc-trt-kins.z-rot-point", 0}, {"xyzbc-trt-kins.x-offset", 0}, {"xyzbc-trt-kins.tool-offset", 0}}},
    {"xyzab_tdr_kins", 5, {{"xyzab_tdr_kins.tool-offset-z", 0}, {"xyzab_tdr_kins.z-offset", 0}}},
    {"xyzacb_trsrn",
     6,
     {{"xyzacb_trsrn_kins.y-pivot", 0}, {"xyzacb_trsrn_kins.pre-rot", 0}, {"kinstype.is-2", 0}}},
    {"xyzbca_trsrn",
     6,
     {{"xyzbca_trsrn_kins.x-rot-axis", 0}, {"xyzbca_trsrn_kins.secondary-angle", 0}, {"kinstype.is-0", 1}}},
    {"userkins", 3, {{"userkins.0.fpin", 0}}},
    {"scarakins",
     6,
     {{"scarakins.D1", 490},
      {"scarakins.D2", 340},
      {"scarakins.D3", 50},
      {"scarakins.D4", 250},
      {"scarakins.D6", 50}}},
    {"pumakins",
     6,
     {{"pumakins.A2", 300},
      {"pumakins.A3", 50},
      {"pumakins.D3", 70},
      {"pumakins.D4", 400},
      {"pumakins.D6", 70}}},
    {"three21kins",
     6,
     {{"three21kins.a1", 0},
      {"three21kins.a2", 0},
      {"three21kins.b", 35},
      {"three21kins.c1", 320},
      {"three21kins.c2", 225},
      {"three21kins.c3", 225},
      {"three21kins.c4", 65}}},
    {"genserkins",
     6,
     {{"genserkins.A-2", 300},
      {"genserkins.ALPHA-1", -1.5707963267948966},
      {"genserkins.D-3", 400},
      {"genserkins.unrotate-5", 0},
      {"genserkins.max-iterations", 100},
      {"genserkins.last-iterations", 0}}},
    {"genhexkins",
     6,
     {{"genhexkins.base.0.x", -22.95},
      {"genhexkins.platform.5.y", -4.884},
      {"genhexkins.base-n.1.y", -0.707107},
      {"genhexkins.platform-n.3.x", 0.866025},
      {"genhexkins.limit-iterations", 120},
      {"genhexkins.convergence-criterion", 1e-9},
      {"genhexkins.max-error", 500},
      {"genhexkins.x", 0},
      {"genhexkins.correction.5", 0},
      {"skgui.c", 0},
      {"genhexkins.fwd-kins-fail", 0}}},
    {"pentakins",
     5,
     {{"pentakins.base.4.y", -492.96},
      {"pentakins.effector.0.z", -185.5},
      {"pentakins.max-error", 100},
      {"pentakins.limit-iterations", 120}}},
    {"rosekins", 3, {{"rosekins.revolutions", 0}, {"rosekins.bigtheta_degrees", 0}}},
};

/// The page shows names with numbers with N instead.
std::string as_in_page(const std::string &name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool is_number = std::isdigit(static_cast<unsigned char>(name[i])) != 0 && i > 0 &&
                               (name[i - 1] == '.' || name[i - 1] == '-') &&
                               (i + 1 == name.size() || name[i + 1] == '.');
        out += is_number ? 'N' : name[i];
    }
    return out;
}

std::string page_of(const std::string &module) {
    std::ifstream file(std::filesystem::path(MW_MAN_FOLDER) / (module + ".9.scd"));
    std::string text(std::istreambuf_iterator<char>(file), {});
    std::erase(text, '\\');
    return text;
}

TEST(KinematicsModules, HavePinsWithTheValuesOfLinuxCNC) {
    for (const Module &module : MODULES) {
        SCOPED_TRACE(module.name);
        Loaded machine;
        ASSERT_EQ(machine.load(module.name), "ok");
        for (const auto &[name, start] : module.starts) {
            ASSERT_TRUE(machine.host->hal().values().get(name).has_value()) << name;
            EXPECT_DOUBLE_EQ(machine.value(name), start) << name;
        }
    }
}

TEST(KinematicsModules, EveryPinIsInThePage) {
    for (const Module &module : MODULES) {
        Loaded machine;
        ASSERT_EQ(machine.load(module.name), "ok");
        const std::string page = page_of(module.name);
        ASSERT_FALSE(page.empty()) << module.name;
        for (const auto &pin : machine.host->hal().pins().list("*")) {
            if (pin.name.find(".fdemo.") == std::string::npos) {  // function times, which every function has
                EXPECT_NE(page.find("*" + as_in_page(pin.name) + "*"), std::string::npos) << pin.name;
            }
        }
    }
}

TEST(KinematicsModules, MotionLoadsOverEachOfThem) {
    for (const Module &module : MODULES) {
        Loaded machine;
        ASSERT_EQ(machine.load("tpmod"), "ok");
        ASSERT_EQ(machine.load("homemod"), "ok");
        ASSERT_EQ(machine.load(module.name), "ok");
        EXPECT_EQ(machine.load("motmod", {"num_joints=" + std::to_string(module.joints)}), "ok")
            << module.name;
    }
}

TEST(KinematicsModules, RefuseWordsThatTheyDoNotKnow) {
    for (const char *name : {"5axiskins", "xyzac-trt-kins", "scarakins"}) {
        Loaded machine;
        EXPECT_NE(machine.load(name, {"coordinates=XYQ"}).find("XYZABCUVW"), std::string::npos);
        EXPECT_NE(machine.load(name, {"sparm=identitylast"}).find("identityfirst"), std::string::npos);
        EXPECT_EQ(machine.load(name, {"coordinates=XYZBCWY", "sparm=identityfirst"}), "ok");
    }
}

}  // namespace
}  // namespace mw::motion
