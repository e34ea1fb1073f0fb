# SPDX-License-Identifier: GPL-2.0-or-later
# Writes OUTPUT, a source with the texts of the models FILES.
set(entries "")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(APPEND entries "    {\"${name}\", R\"model(${text})model\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: GPL-2.0-or-later
#include \"drivers/mesa/board/model.hh\"

namespace mw::mesa::board {

namespace {

constexpr BuiltInModel MODELS[] = {
${entries}};

}  // namespace

std::span<const BuiltInModel> built_in_models() noexcept {
    return MODELS;
}

}  // namespace mw::mesa::board
")
