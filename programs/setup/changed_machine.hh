// SPDX-License-Identifier: GPL-2.0-or-later
// Opens a machine that `millwright setup` has written, and writes it again with other answers. Edits of its
// files survive, or are reported as conflicts.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"
#include "machine/setup/merge.hh"
#include "machine/setup/plan.hh"

namespace mw::programs {

/// The answers that are recorded in the folder of a machine.
Result<setup::Answers> recorded_answers(const std::string &folder);

/// The answers of a machine with the changes in `given`. An answer that was a preset follows the changed
/// preset. Answers to questions that are no longer asked are dropped.
setup::Answers changed_answers(const setup::Answers &recorded, const setup::Answers &given);

/// The rule for lines that both a person and the new answers have changed.
enum class ConflictRule { REPORT, KEEP_EDITED, TAKE_NEW };

struct FileChange {
    std::string name;  ///< name in the folder
    enum class Type { UNCHANGED, CHANGED, CREATED, REMOVED } type = Type::UNCHANGED;
    std::vector<setup::Conflict> conflicts;
};

struct MachineChange {
    std::vector<FileChange> files;
    bool isWritten = false;

    bool hasConflicts() const;
};

/// Writes the files of `plan` to the folder of a machine. With REPORT nothing is written if there is a
/// conflict. `plan` must be free of faults.
Result<MachineChange> change_machine(const std::string &folder, const setup::Plan &plan,
                                     const setup::Answers &given, ConflictRule rule);

/// One line for each file that changes, and the three versions of each conflict.
std::string change_text(const MachineChange &change);

}  // namespace mw::programs
