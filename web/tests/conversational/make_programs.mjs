// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the programs of forms, for judges that are not written in TypeScript. Each line of standard input is a JSON object:
//   {"job": {...}, "facts": {...}, "dxf": {"0": "text of a DXF file for the first operation"}, "isPartial": true}
// and each line of standard output the answer: {"job", "jobFaults", "stepFaults", "program"}; the program is null where there are
// faults. `isPartial`: fields that are missing get their defaults.
// usage: node make_programs.mjs < cases > answers
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';

const web = join(dirname(fileURLToPath(import.meta.url)), '../..');
const { buildSync } = createRequire(join(web, 'package.json'))('esbuild');
const folder = mkdtempSync(join(tmpdir(), 'mw-forms-'));
try {
  const outfile = join(folder, 'forms.mjs');
  buildSync({ entryPoints: [join(web, 'src/lib/conversational/all.ts')], bundle: true, format: 'esm', platform: 'node', outfile, logLevel: 'error' });
  const forms = await import(pathToFileURL(outfile));
  const out = [];
  for (const line of readFileSync(0, 'utf8').split('\n')) {
    if (line.trim() !== '') {
      out.push(JSON.stringify(answer(forms, JSON.parse(line))));
    }
  }
  process.stdout.write(`${out.join('\n')}\n`);
} finally {
  rmSync(folder, { recursive: true });
}

function answer(forms, { job, facts = forms.NOTHING_KNOWN, dxf = {}, isPartial = false }) {
  for (const [i, text] of Object.entries(dxf)) {
    job.steps[i].values.drawing = forms.packed(forms.readDxf(text, job.unit) ?? []);
  }
  for (const step of job.steps) {
    const operation = forms.operationOf(step.type);
    if (isPartial && operation !== null) {
      step.values = forms.filled(operation, step.values, forms.contextOf(job, facts));
    }
  }
  const [jobFaults, stepFaults] = [forms.jobFaults(job), forms.stepFaults(job, facts)];
  const program = forms.isFaultless(job, facts) ? forms.withForm(forms.programOf(job, facts), job) : null;
  return { job, jobFaults, stepFaults, program };
}
