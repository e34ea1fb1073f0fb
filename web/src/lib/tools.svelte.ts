// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table, read again when the status reports another version.
import { machine, tellLocally } from './machine.svelte';

export interface Tool {
  toolno: number;
  pocketno: number;
  offset: number[];
  diameter: number;
  frontangle_deg: number;
  backangle_deg: number;
  orientation: number;
  comment: string;
}

export const tools = $state<{ version: number; list: Tool[] }>({ version: -1, list: [] });

let isReading = false;

/** Call it in an effect: reads a new table. */
export function followTools(): void {
  const wanted = machine.isMachineUp ? (machine.status?.tool.table_version ?? -1) : -1;
  if (wanted === -1) {
    tools.version = -1;
    return;
  }
  if (wanted !== tools.version && !isReading) {
    isReading = true;
    void read().finally(() => {
      isReading = false;
    });
  }
}

async function read(): Promise<void> {
  const answer = await fetch('/api/tools');
  const told = (await answer.json()) as { version?: number; tools?: Tool[]; error?: string };
  if (!answer.ok || told.tools === undefined || told.version === undefined) {
    tellLocally(told.error ?? `GET /api/tools: ${answer.status}`);
    return;
  }
  tools.list = told.tools;
  tools.version = told.version;
}

/** The tool prepared by T, 0: an empty spindle; null while it is not known. */
export function preparedTool(): number | null {
  const index = machine.status?.tool.prepared_index ?? -1;
  if (index === 0) {
    return 0; // the entry of the spindle itself: nothing is loaded
  }
  return index < 0 ? null : (tools.list[index]?.toolno ?? null);
}
