// SPDX-License-Identifier: GPL-2.0-or-later
// Executes parsed blocks: modes, order of execution, and what each code does to state and canon.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "interp/ast/program.hh"
#include "interp/canon/canon_queue.hh"
#include "interp/canon/frame.hh"
#include "interp/codes/around_block.hh"
#include "interp/codes/attributes.hh"
#include "interp/codes/block_values.hh"
#include "interp/codes/kept_parameters.hh"
#include "interp/codes/lathe/lathe_layers.hh"
#include "interp/codes/remaps.hh"
#include "interp/codes/saved_modes.hh"
#include "interp/codes/state.hh"
#include "interp/codes/tools/tool_table.hh"
#include "interp/eval/evaluator.hh"
#include "interp/interpreter.hh"

namespace mw::interp::detail {

/// Axes of the selected plane; the normal is where canned cycles move.
struct PlaneAxes {
    int first, second, normal;
};

/// An arc in the selected plane, program coordinates.
struct ArcPlan {
    Pose end;
    double first_centre = 0, second_centre = 0;
    int rotation = 1;  ///< as in ArcFeed
};

/// One canned cycle with its heights resolved, program coordinates along the plane's normal.
struct CyclePlan {
    int code = 0;
    double r = 0, bottom = 0, clear = 0;
};

/// A thread to be cut by G76 [program units, radii].
struct ThreadPlan {
    int spindle = 0, springs = 0;
    double pitch = 0, first_cut = 0, full_depth = 0, degression = 1, taper_length = 0;
    double tangent = 0;  ///< of the infeed angle
    double start_x = 0, start_z = 0, end_z = 0, peak_x = 0;
    double inward = 1;  ///< +1: cuts towards larger X
    double along = 1;   ///< sign of the cut in Z
    bool hasEntryTaper = false, hasExitTaper = false;
};

enum class Outcome { OK, SYNC, PROGRAM_END, CALL_FANUC, RETURN_FANUC, REMAP, RESTART, SCRIPT, PROFILE };

/// Values of named parameters that scripts define.
class ScriptNames {
  public:
    virtual ~ScriptNames() = default;
    virtual bool hasName(std::string_view name) const = 0;
    /// Nothing after setting the fault.
    virtual std::optional<double> value_of(std::string_view name) = 0;
};

class Executor : public BuiltIns {
  public:
    Executor(World &world, ToolSource &tools, ParameterSource &source, const Settings &settings,
             Names &names);

    /// Words, settings and comments of a block; then its codes. False after setting the fault. `line_text` is
    /// looked at when the block has comments.
    bool run(const BlockView &view, std::string_view line_text);

    // What the parts share. The state is copied before a block and put back when it fails.
    State state;
    Parameters parameters;
    CanonQueue canon;
    Fault fault;
    Outcome outcome = Outcome::OK;
    SavedModes saved_modes;
    Remaps remaps;
    BlockPlace block_place;
    ReturnValue returned;
    Awaited awaited;
    ScriptLevels script_levels;

    Evaluator &evaluator() { return evaluator_; }
    World &world() const { return world_; }
    const Settings &settings() const { return settings_; }

    /// Remembers state and queue, so that rollback() can undo the block; commit() keeps what it did.
    void begin_block();
    /// The same for a block that may change no state: whoever changes it calls keep_state() before.
    void begin_light_block();
    void keep_state();
    void commit();
    /// Replays the queued calls that no later block can change.
    void flush(Canon &target);
    void rollback();
    /// After an abort: nothing waits any more.
    void abort_block();
    // exec_remap.cc
    bool resume(const PendingBlock &pending);
    void set_script_names(ScriptNames *names) { script_names_ = names; }
    /// The statements of the ;py, line that the outcome is about.
    const std::string &script_text() const { return script_text_; }
    // For scripts and kept parameters.
    AttributeSources attribute_sources();
    /// The entry of a table as this program has changed it; number of its entries; the place of a tool or -1.
    ToolEntry table_entry(int index) const { return tool_table_.entry(index); }
    ToolSource &tools() const { return tools_; }
    /// The tool at state.tool_index is in the spindle.
    void load_indexed_tool();
    void set_tool_offset(const Pose &offset);
    // exec_lathe.cc
    /// The cycle whose profile the blocks to come give; null outside of one.
    const LatheRequest *lathe_request() const { return lathe_ ? &*lathe_ : nullptr; }
    /// The profile is complete: cuts it.
    bool finish_lathe_cycle();
    void drop_lathe_cycle() { lathe_.reset(); }
    int fanuc_label = 0, fanuc_count = 1;  ///< of the M98 that the outcome is about

    /// Announces the state to the canon, as at the start of a program.
    void announce();
    /// Offsets, spindles' speeds and switches once more: the canon has lost some of them.
    void announce_modes();
    /// Takes positions, tools and switches from the machine.
    void synch();
    ActiveCodes active_codes() const;
    /// New local names and a context of its own for a subroutine; back to the caller's. pop_call() restores
    /// the modes that M73 saved.
    void push_call();
    bool pop_call(bool isFanuc);
    /// Back to `depth` calls, without restoring what M73 saved.
    void drop_calls(std::size_t depth = 0);
    int plane_code() const;
    /// INI values that the program has asked for, as names of parameters.
    const std::set<std::string, std::less<>> &ini_names_read() const { return ini_names_read_; }
    bool hasToolChanges() const { return tool_table_.hasChanges(); }
    bool isBuiltInName(std::string_view name) const override;
    std::optional<double> built_in(std::string_view name) const override;
    double built_in(int number) const override;

    // Handlers, one per row of the table of codes.
    bool do_feed_word(const Code &code, const BlockValues &values);
    bool do_speed_word(const Code &code, const BlockValues &values);
    bool do_tool_word(const Code &code, const BlockValues &values);
    // exec_modes.cc
    bool do_units(const Code &code, const BlockValues &values);
    bool do_plane(const Code &code, const BlockValues &values);
    bool do_distance(const Code &code, const BlockValues &values);
    bool do_centre_distance(const Code &code, const BlockValues &values);
    bool do_diameter(const Code &code, const BlockValues &values);
    bool do_feed_mode(const Code &code, const BlockValues &values);
    bool do_retract(const Code &code, const BlockValues &values);
    bool do_control(const Code &code, const BlockValues &values);
    // exec_spindle.cc
    bool do_spindle_mode(const Code &code, const BlockValues &values);
    bool do_spindle(const Code &code, const BlockValues &values);
    bool do_orient(const Code &code, const BlockValues &values);
    // exec_tools.cc
    bool do_change_tool(const Code &code, const BlockValues &values);
    bool do_tool_number(const Code &code, const BlockValues &values);
    bool do_tool_offset(const Code &code, const BlockValues &values);
    bool do_g10(const Code &code, const BlockValues &values);
    // exec_offsets.cc
    bool do_coordinates(const Code &code, const BlockValues &values);
    bool do_g92(const Code &code, const BlockValues &values);
    bool do_reference(const Code &code, const BlockValues &values);
    // exec_io.cc
    bool do_coolant(const Code &code, const BlockValues &values);
    bool do_override(const Code &code, const BlockValues &values);
    bool do_output(const Code &code, const BlockValues &values);
    bool do_wait_input(const Code &code, const BlockValues &values);
    bool do_user(const Code &code, const BlockValues &values);
    bool do_dwell(const Code &code, const BlockValues &values);
    bool do_stop(const Code &code, const BlockValues &values);
    bool do_end(const Code &code, const BlockValues &values);
    bool do_fanuc(const Code &code, const BlockValues &values);
    bool do_context(const Code &code, const BlockValues &values);
    // exec_motion.cc
    bool do_straight(const Code &code, const BlockValues &values);
    bool do_cubic_spline(const Code &code, const BlockValues &values);
    bool do_quadratic_spline(const Code &code, const BlockValues &values);
    bool do_nurbs_point(const Code &code, const BlockValues &values);
    bool do_nurbs_end(const Code &code, const BlockValues &values);
    bool do_arc(const Code &code, const BlockValues &values);
    bool do_cycle(const Code &code, const BlockValues &values);
    bool do_comp(const Code &code, const BlockValues &values);
    bool do_thread(const Code &code, const BlockValues &values);
    bool do_thread_cycle(const Code &code, const BlockValues &values);
    bool do_probe(const Code &code, const BlockValues &values);
    bool do_lathe_cycle(const Code &code, const BlockValues &values);
    bool do_cancel_motion(const Code &code, const BlockValues &values);
    bool do_nothing(const Code &code, const BlockValues &values);

  private:
    bool run_last_comment(const BlockView &view, std::string_view line_text);
    bool evaluate(const BlockView &view, BlockValues &values);
    bool add_code(char letter, double number, std::uint32_t column, BlockValues &values);
    bool insert_code(const Code &code, std::uint32_t column, BlockValues &values);
    bool choose_motion(BlockValues &values);
    bool check_axes(const BlockValues &values);
    bool check_words(const BlockValues &values);
    /// A parameter and the value that it is to have.
    struct MadeSetting {
        int number = 0;
        NameId name = NO_ID;
        double value = 0;
    };
    bool apply_settings(const BlockView &view);
    bool compute_setting(const Arena &arena, const Setting &setting, MadeSetting &out);
    bool isStateSafe(const BlockValues &values) const;
    bool run_codes(const BlockValues &values, std::size_t first);
    const Code *lookup(char letter_char, int number) const;
    bool stop_at_remap(const BlockValues &values, std::size_t index);
    bool run_code(char letter_char, int number, BlockValues values);
    bool restore_context(const State &wanted);
    bool restore_geometry(const State &saved);
    bool restore_spindles(const State &saved);
    void restore_overrides(const State &saved);
    void synch_tool(const MachineSnapshot &snapshot);
    void restore_modes_at_end();
    bool spindle_of(const BlockValues &values, int &spindle);
    bool whole_word(const BlockValues &values, char name, int &out);

    void put_tool_entry(int index, const ToolEntry &entry);
    bool find_tool(int toolno, std::uint32_t column, int &index);
    void load_tool(int index);
    void apply_tool_offset(const Pose &offset, int code);
    void retain_tool_offset();
    bool reload_tools();
    bool check_pitch(int spindle, double pitch, std::uint32_t column);
    bool set_tool_data(int l, const BlockValues &values);
    bool set_coordinate_system(int l, const BlockValues &values);
    void set_tool_axes(int l, const BlockValues &values, Pose &offset) const;

    Pose parameter_pose(int first) const;  ///< machine units in the file, program units here
    void set_parameter_pose(int first, const Pose &pose);
    void change_frame(const Frame &made);
    void send_coordinates();
    bool set_g92(const BlockValues &values);

    Frame frame() const { return {state.g5x, state.g92, state.tool_offset, state.rotation_deg}; }
    /// Factor for lengths of the parameter file and the tool table [machine units] to program units and back.
    double machine_to_program() const;
    Pose reported_position() const;
    KeptSources kept_sources() const;
    Pose target(const BlockValues &values) const;
    bool polar_target(const BlockValues &values, Pose &end);
    bool straight_target(const BlockValues &values, Pose &end);
    bool check_feed(const BlockValues &values, std::string_view code);
    bool check_feed_per_revolution();
    bool check_spline(const BlockValues &values, std::string_view code, bool isPlaneFree);
    bool check_open_nurbs(const BlockValues &values);
    void keep_control_point(const NurbsPoint &point);
    bool send_nurbs(NurbsFeed nurbs);
    void send_inverse_time(double length);
    double straight_length(const Pose &end) const;
    PlaneAxes plane_axes() const;
    bool plan_arc(bool isCounterclockwise, const BlockValues &values, ArcPlan &arc);
    bool plan_centre_arc(const BlockValues &values, ArcPlan &arc);
    bool plan_radius_arc(double radius, ArcPlan &arc);
    double arc_sweep(const ArcPlan &arc, double x0, double y0) const;
    void send_arc(const ArcPlan &arc);
    bool take_cycle_words(const Code &code, const BlockValues &values);
    bool check_cycle(const Code &code, const BlockValues &values, int &repeats);
    void cycle_move(bool isRapid, int axis, double value);
    void start_spindle(int direction);
    void tap_move(double height);
    void run_cycle(const CyclePlan &plan);
    void run_peck(const CyclePlan &plan);
    void run_tap(const CyclePlan &plan, int direction);
    void run_back_bore(const CyclePlan &plan, int direction);
    bool record_profile(BlockValues values);
    bool record_arc(const BlockValues &values, const Pose &from);
    bool take_corner_word(const BlockValues &values);
    bool run_lathe_cycle(const LatheRequest &request);
    bool send_profile_move(const ProfileMove &move, const CutFrame &frame);
    bool check_thread_cycle(const BlockValues &values, ThreadPlan &plan);
    void thread_pass(const ThreadPlan &plan, double depth);
    Point comp_normal(Point direction) const;
    Point comp_shift() const;
    void send_comp_arc(Point to, Point centre, int rotation, const Pose &end);
    Pose in_plane(Pose pose, Point point) const;
    void end_comp();
    void patch_comp(Point end);
    void send_rapid_around(Point from, Point to, Point corner);
    bool join_comp(CompElement &next, bool isRapid, std::string_view what);
    bool enter_comp_by_arc(const ArcPlan &arc, CompElement &next);
    bool comp_arc(const ArcPlan &arc);
    bool comp_straight(bool isRapid, const Pose &end);
    std::string code_name(const Code &code) const;

    unsigned axis_mask_ = ~0U;       ///< of the machine, when absent_axes_ was made
    std::uint32_t absent_axes_ = 0;  ///< letters of the axes that it lacks
    World &world_;
    ToolSource &tools_;
    ParameterSource &source_;
    const Settings &settings_;
    Names &names_;
    Evaluator evaluator_;
    ToolTable tool_table_;
    int block_number_ = -1;  ///< the N word of the block
    mutable std::set<std::string, std::less<>> ini_names_read_;
    ScriptNames *script_names_ = nullptr;
    std::string script_text_, comment_;  ///< of the block
    BlockValues values_;                 ///< of the block that runs
    std::vector<MadeSetting> made_;      ///< of the block that runs
    State before_;                       ///< as the block found it, once keep_state() was called for it
    bool isStateKept_ = false;
    std::vector<NurbsPoint> control_points_;
    std::optional<LatheRequest> lathe_;
    /// The last roughing cycle of the program, for the G70 that follows it.
    struct Roughed {
        int label = 0;  ///< of the profile's subroutine
        bool isFacing = false;
    };
    std::optional<Roughed> roughed_;
    std::size_t queued_before_ = 0;
    std::vector<std::pair<std::size_t, CanonCall>> patched_;  ///< calls that the block changed, as they were
};

}  // namespace mw::interp::detail
