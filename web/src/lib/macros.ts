// SPDX-License-Identifier: GPL-2.0-or-later
// Entries of [MDI_COMMAND_LIST].

export interface Macro {
  label: string;
  lines: string[];
}

/**
 * "G0 X0; G0 Y0, Left\nCorner": lines separated by `;`, and after the last comma a label with `\n` between
 * its lines.
 */
export function macroOf(text: string): Macro {
  const comma = text.lastIndexOf(',');
  const commands = comma < 0 ? text : text.slice(0, comma);
  const label = comma < 0 ? '' : text.slice(comma + 1).replaceAll('\\n', ' ').trim();
  return { label: label || commands.trim(), lines: commands.split(';').map((one) => one.trim()).filter((one) => one !== '') };
}
