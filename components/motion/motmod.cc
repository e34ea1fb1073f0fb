// SPDX-License-Identifier: GPL-2.0-or-later
// The motion controller as a HAL component: threads base-thread and servo-thread, functions
// motion-command-handler and motion-controller, the path planner below the threads, and the channels to the
// task process in shared memory.
#include <atomic>
#include <cstdint>
#include <memory>
#include <new>

#include "hal/include/hal.h"
#include "hal/include/millwright_ext.h"
#include "hal/include/rtapi_app.h"
#include "machine/io/tool_offset_pins.hh"
#include "motion/hal/module_homing.hh"
#include "motion/hal/module_kinematics.hh"
#include "motion/hal/module_planner.hh"
#include "motion/hal/pins.hh"
#include "motion/planner/path_planner.hh"
#include "motion/servo/controller.hh"

using namespace mw;

static long base_period_nsec = 0;
RTAPI_MP_LONG(base_period_nsec, "period of base-thread [ns]; 0: none");
static int key = 0;
RTAPI_MP_INT(key, "accepted; the memory of motion has no key");
static int base_thread_fp = 0;
RTAPI_MP_INT(base_thread_fp, "accepted; every thread may use floating point");
static long servo_period_nsec = 1000000;
RTAPI_MP_LONG(servo_period_nsec, "period of servo-thread [ns]");
static long traj_period_nsec = 0;
RTAPI_MP_LONG(traj_period_nsec, "accepted; the path planner has its own period");
static int num_joints = MAX_JOINTS;
RTAPI_MP_INT(num_joints, "joints, 1 to 16");
static int num_spindles = 1;
RTAPI_MP_INT(num_spindles, "spindles, 1 to 8");
static int num_dio = 4;
RTAPI_MP_INT(num_dio, "digital inputs and outputs, 1 to 64");
static int num_aio = 4;
RTAPI_MP_INT(num_aio, "analog inputs and outputs, 1 to 64");
static int num_misc_error = 0;
RTAPI_MP_INT(num_misc_error, "further error inputs, 0 to 64");
static int num_extrajoints = 0;
RTAPI_MP_INT(num_extrajoints, "the last joints, homed and then moved by joint.N.posthome-cmd");
static int unlock_joints_mask = 0;
RTAPI_MP_INT(unlock_joints_mask, "joints with unlock pins");

namespace {

constexpr int FAILED = -22;  // EINVAL

/// Objects that are too large for the library itself.
struct Memory {
    alignas(motion::PathLink) unsigned char link[sizeof(motion::PathLink)];
    alignas(motion::Controller) unsigned char controller[sizeof(motion::Controller)];
    alignas(motion::PathPlanner) unsigned char planner[sizeof(motion::PathPlanner)];
};

/// All data of this load except the pins, the channels and the block of the tool offset, which are in shared
/// memory.
struct Module {
    motion::ModuleKinematics kinematics;
    motion::ModuleHoming homing;
    bool homing_foreign = false;  ///< a user module does the homing
    motion::ModulePlanner speeds;
    bool are_speeds_foreign = false;  ///< a user module plans the speeds
    motion::PathLink *link = nullptr;
    motion::Inputs in;
    motion::Outputs out;
    motion::MotionPins *pins = nullptr;
    motion::Channels *channels = nullptr;
    io::ToolOffsetPins *tool_offset_pins = nullptr;
    io::ToolOffsetBlock *tool_offset = nullptr;
    motion::Controller *controller = nullptr;
    motion::PathPlanner *planner = nullptr;
    Memory *memory = nullptr;
    int component = -1, planner_id = -1, shmem_id = -1, tool_offset_id = -1;
    rtapi_u32 is_safe = 0;  ///< the task process has ended, motion has stopped and the amplifiers are off
};

Module module;
[[gnu::hot]] void handle_commands(void *, long) {
    if (module.channels->hasCommands()) {
        module.pins->read(module.in);
        module.controller->handle_commands(module.in);
    }
}

[[gnu::hot]] void control(void *, long) {
    module.pins->read(module.in);
    module.controller->step(module.in, module.out);
    module.pins->write(module.out);
    module.tool_offset_pins->step(*module.tool_offset);
    const bool safe = module.out.status.isTaskLost && !module.out.status.isEnabled;
    std::atomic_ref(module.is_safe).store(safe ? 1 : 0, std::memory_order_release);
}

void plan(void *, long long) {
    module.planner->update();
}

bool isInRange(const char *name, long value, long low, long high) {
    if (value < low || value > high) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: %s=%ld is out of range, %ld to %ld are possible\n", name,
                        value, low, high);
        return false;
    }
    return true;
}

bool isConfigured() {
    const bool sound = isInRange("num_joints", num_joints, 1, MAX_JOINTS) &&
                       isInRange("num_spindles", num_spindles, 1, MAX_SPINDLES) &&
                       isInRange("num_dio", num_dio, 1, MAX_DIGITAL_IO) &&
                       isInRange("num_aio", num_aio, 1, MAX_ANALOG_IO) &&
                       isInRange("num_misc_error", num_misc_error, 0, MAX_DIGITAL_IO) &&
                       isInRange("servo_period_nsec", servo_period_nsec, 1000, 100000000) &&
                       isInRange("base_period_nsec", base_period_nsec, 0, servo_period_nsec);
    if (!sound) {
        return false;
    }
    return isInRange("num_extrajoints", num_extrajoints, 0, num_joints - 1);
}

int find_kinematics() {
    const char *missing = module.kinematics.find(num_joints - num_extrajoints);
    if (missing != nullptr) {
        rtapi_print_msg(
            RTAPI_MSG_ERR,
            "motmod: no loaded module exports %s: load the kinematics (for instance 'loadrt trivkins') "
            "before motmod\n",
            missing);
        return -2;  // ENOENT
    }
    const kinematics::IdentityMap *map = module.kinematics.identity();
    if (num_extrajoints > 0 && map != nullptr && map->num_joints != num_joints - num_extrajoints) {
        rtapi_print_msg(
            RTAPI_MSG_ERR,
            "motmod: num_joints=%d with num_extrajoints=%d leaves %d joints to the kinematics, which moves "
            "%d: see [KINS]JOINTS and coordinates= of the kinematics\n",
            num_joints, num_extrajoints, num_joints - num_extrajoints, map->num_joints);
        return FAILED;
    }
    return module.kinematics.hold(module.component);
}

void set_unlock(int joint, int isWanted) {
    module.homing.set_unlock(joint, isWanted != 0);
}

int get_unlock(int joint) {
    return module.homing.isUnlocked(joint) ? 1 : 0;
}

/// Finds a user module for homing, if one is loaded.
int find_homing() {
    const char *missing = nullptr;
    const auto found = module.homing.find(missing);
    if (found == motion::ModuleHoming::Found::NONE) {
        return 0;
    }
    if (found == motion::ModuleHoming::Found::SOME) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "motmod: a loaded module has some functions of a homing module, but not %s: see "
                        "docs/developer/extending/homing.md\n",
                        missing);
        return -2;  // ENOENT
    }
    const double period_s = static_cast<double>(servo_period_nsec) * 1e-9;
    const int started = module.homing.start_module(module.component, period_s, {num_joints, num_extrajoints},
                                                   set_unlock, get_unlock);
    if (started != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: the homing module cannot be used: homing_init answers %d\n",
                        started);
        return started < 0 ? started : FAILED;
    }
    module.homing_foreign = true;
    return module.homing.hold(module.component);
}

/// Finds a user module that plans speeds, if one is loaded.
int find_planner() {
    const char *missing = nullptr;
    const auto found = module.speeds.find(missing);
    if (found == motion::ModulePlanner::Found::NONE) {
        return 0;
    }
    if (found == motion::ModulePlanner::Found::SOME) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "motmod: a loaded module has a function of a planner module, but not %s: see "
                        "docs/developer/extending/planner.md\n",
                        missing);
        return -2;  // ENOENT
    }
    const int started = module.speeds.start(module.component, static_cast<double>(servo_period_nsec) * 1e-9);
    if (started < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: the planner module cannot be used: mw_tp_init answers %d\n",
                        started);
        return started;
    }
    module.are_speeds_foreign = true;
    return 0;
}

bool hasPin(const char *name) {
    hal_type_t type = HAL_BIT;
    hal_data_u *data = nullptr;
    bool connected = false;
    return hal_get_pin_value_by_name(name, &type, &data, &connected) == 0;
}

int make_channels() {
    module.shmem_id =
        rtapi_shmem_new(motion::Channels::SHMEM_KEY, module.component, sizeof(motion::Channels));
    void *memory = nullptr;
    if (module.shmem_id < 0 || rtapi_shmem_getptr(module.shmem_id, &memory) != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: no shared memory for the motion channels (%d bytes)\n",
                        static_cast<int>(sizeof(motion::Channels)));
        return module.shmem_id < 0 ? module.shmem_id : FAILED;
    }
    module.channels = new (memory) motion::Channels;
    module.channels->layout_bytes = sizeof(motion::Channels);
    module.channels->magic = motion::Channels::MAGIC;
    return 0;
}

int make_pins() {
    void *memory = hal_malloc(static_cast<long>(sizeof(motion::MotionPins)));
    if (memory == nullptr) {
        return -12;  // ENOMEM
    }
    module.pins = new (memory) motion::MotionPins();
    motion::PinCounts counts{num_joints,     num_spindles,       num_dio,        num_aio,
                             num_misc_error, unlock_joints_mask, num_extrajoints};
    counts.isSwitchable = module.kinematics.type_switch() != nullptr;
    counts.areHomingPinsMade = hasPin("joint.0.home-sw-in");
    return module.pins->declare(module.component, counts);
}

/// These belong to the I/O controller; only the thread and the component are those of motion.
int make_tool_offset_pins() {
    const int key = io::ToolOffsetBlock::SHMEM_KEY;
    module.tool_offset_id = rtapi_shmem_new(key, module.component, sizeof(io::ToolOffsetBlock));
    void *block = nullptr;
    if (module.tool_offset_id < 0 || rtapi_shmem_getptr(module.tool_offset_id, &block) != 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: no shared memory for the tool offset (%d bytes)\n",
                        static_cast<int>(sizeof(io::ToolOffsetBlock)));
        return module.tool_offset_id < 0 ? module.tool_offset_id : FAILED;
    }
    void *pins = hal_malloc(static_cast<long>(sizeof(io::ToolOffsetPins)));
    if (pins == nullptr) {
        return -12;  // ENOMEM
    }
    module.tool_offset = new (block) io::ToolOffsetBlock;
    module.tool_offset->layout_bytes = sizeof(io::ToolOffsetBlock);
    module.tool_offset->magic = io::ToolOffsetBlock::MAGIC;
    module.tool_offset_pins = new (pins) io::ToolOffsetPins;
    return module.tool_offset_pins->declare(module.component);
}

/// Does nothing when an earlier module has already created the thread with that period.
int make_thread(const char *name, long period_ns, int uses_fp) {
    const long long there = mw_ext_thread_period(name);
    if (there == 0) {
        return hal_create_thread(name, static_cast<unsigned long>(period_ns), uses_fp);
    }
    if (there != period_ns) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "motmod: the thread %s that is there has a period of %lld ns, motion wants %ld ns\n",
                        name, there, period_ns);
        return FAILED;
    }
    return 0;
}

int make_controller() {
    module.memory = static_cast<Memory *>(mw_ext_memory_new(sizeof(Memory)));
    if (module.memory == nullptr) {
        rtapi_print_msg(RTAPI_MSG_ERR, "motmod: no memory for the controller (%d bytes)\n",
                        static_cast<int>(sizeof(Memory)));
        return -12;  // ENOMEM
    }
    const double period_s = static_cast<double>(servo_period_nsec) * 1e-9;
    module.link = new (module.memory->link) motion::PathLink;
    module.controller = new (module.memory->controller)
        motion::Controller({num_joints, num_spindles, num_dio, num_aio, period_s, num_extrajoints,
                            module.homing_foreign ? &module.homing : nullptr},
                           module.kinematics, *module.channels, *module.link);
    module.planner = new (module.memory->planner)
        motion::PathPlanner({period_s, num_joints - num_extrajoints, num_spindles, num_dio, num_aio,
                             module.are_speeds_foreign ? &module.speeds : nullptr},
                            module.kinematics, *module.channels, *module.link);
    return 0;
}

int make_functions() {
    int status = hal_export_funct("motion-command-handler", handle_commands, nullptr, 1, 0, module.component);
    if (status == 0) {
        status = hal_export_funct("motion-controller", control, nullptr, 1, 0, module.component);
    }
    if (status == 0 && base_period_nsec > 0) {
        status = make_thread("base-thread", base_period_nsec, base_thread_fp);
    }
    if (status == 0) {
        status = make_thread("servo-thread", servo_period_nsec, 1);
    }
    return status;
}

int start_planner() {
    // Long compared with the servo period, but too short for an operator to notice.
    constexpr long long SHORTEST_NS = 5000000;
    const long long servo = servo_period_nsec;
    const long long period = servo * ((SHORTEST_NS + servo - 1) / servo);
    module.planner_id = mw_ext_planner_new("motion-planner", period, plan, nullptr);
    return module.planner_id > 0 ? 0 : module.planner_id;
}

/// The kernel reports the end of the task process; the controller learns it through the channels.
int watch_task() {
    static_assert(sizeof(module.channels->isTaskDead) == sizeof(rtapi_u32));
    auto *is_gone = reinterpret_cast<rtapi_u32 *>(&module.channels->isTaskDead);
    const int status = mw_ext_watch_controller(is_gone, &module.is_safe, module.component);
    static_assert(sizeof(module.channels->host_looks) == sizeof(rtapi_u32));
    auto *looks = reinterpret_cast<rtapi_u32 *>(&module.channels->host_looks);
    return status == 0 ? mw_ext_count_looks(looks, module.component) : status;
}

void take_down() {
    if (module.planner_id > 0) {
        mw_ext_planner_delete(module.planner_id);
    }
    if (module.channels != nullptr) {
        module.channels->magic = 0;
        rtapi_shmem_delete(module.shmem_id, module.component);
    }
    if (module.tool_offset != nullptr) {
        module.tool_offset->magic = 0;
        rtapi_shmem_delete(module.tool_offset_id, module.component);
    }
    hal_exit(module.component);  // no thread calls a function of this module after it
    if (module.planner != nullptr) {
        std::destroy_at(module.planner);
        std::destroy_at(module.controller);
        std::destroy_at(module.link);
    }
    mw_ext_memory_delete(module.memory, sizeof(Memory));
}

}  // namespace

int rtapi_app_main(void) {
    if (!isConfigured()) {
        return FAILED;
    }
    module.component = hal_init("motmod");
    if (module.component < 0) {
        return module.component;
    }
    int status = find_kinematics();
    status = status == 0 ? find_homing() : status;
    status = status == 0 ? find_planner() : status;
    status = status == 0 ? make_channels() : status;
    status = status == 0 ? make_pins() : status;
    status = status == 0 ? make_tool_offset_pins() : status;
    status = status == 0 ? make_controller() : status;
    status = status == 0 ? make_functions() : status;
    status = status == 0 ? start_planner() : status;
    status = status == 0 ? watch_task() : status;
    status = status == 0 ? hal_ready(module.component) : status;
    if (status < 0) {
        take_down();
    }
    return status;
}

void rtapi_app_exit(void) {
    take_down();
}
