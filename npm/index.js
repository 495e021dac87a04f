// The commands of `ductile`, as functions from objects to objects: the program itself, compiled to WebAssembly, reads the
// object as the file that it would be, and what it prints with --json is returned.
import factory from './command.js';
import {instantiate} from './instantiate.js';

/** Input that the command refuses (exit 2), or a failure of its own (exit 1), in the command's words. */
export class DuctileError extends Error {
  constructor(lines, exit) {
    super(lines.join('\n'));
    this.name = 'DuctileError';
    this.lines = lines;
    this.exit = exit;
  }
}

const flag = (name) => '--' + name.replace(/[A-Z]/g, (letter) => '-' + letter.toLowerCase());

// What belongs to the command line: files that it writes, and how it prints.
const refused = new Set(['out', 'history', 'picture', 'pictureAt', 'replay', 'json', 'help']);

/** {velocityIterations: 8, fixedGravity: true} as --velocity-iterations 8 --fixed-gravity. */
function words(options) {
  return Object.entries(options).flatMap(([name, value]) => {
    if (!/^[a-zA-Z]+$/.test(name) || refused.has(name)) throw new TypeError(`there is no option '${name}' here`);
    if (value === undefined || value === false) return [];
    return value === true ? [flag(name)] : [flag(name), String(value)];
  });
}

/** The commands, once the program is there. */
export default async function ductile() {
  let out = [], err = [];  // bytes: a program that writes lines takes itself to be in a terminal, and shows its progress
  const program = await instantiate(factory, 'command.wasm',
      {stdin: () => null, stdout: (byte) => out.push(byte), stderr: (byte) => err.push(byte)});
  const text = (bytes) => new TextDecoder().decode(Uint8Array.from(bytes));
  const lines = (bytes) => text(bytes).split('\n').filter((line) => line !== '');

  function run(command, file, object, {files = {}, ...options} = {}) {
    const {FS, stackSave, stackRestore} = program;
    const names = [file, ...Object.keys(files)];
    if (names.some((name) => name.includes('/')) || file in files)
      throw new TypeError("files are named without a folder, and none '" + file + "'");
    const stack = stackSave();  // callMain leaves its arguments there
    out = [], err = [];
    try {
      FS.writeFile(file, typeof object === 'string' ? object : JSON.stringify(object));
      for (const name of Object.keys(files)) FS.writeFile(name, files[name]);
      const exit = program.callMain([command, file, ...words(options), ...(options.to ? [] : ['--json'])]);
      if (exit !== 0) throw new DuctileError(lines(err), exit);
    } finally {
      for (const name of names) if (FS.analyzePath(name).exists) FS.unlink(name);
      stackRestore(stack);
    }
    for (const line of lines(err)) console.warn(line);
    return options.to === 'cpp' ? text(out) : JSON.parse(text(out));
  }

  return {
    section: (section, options) => run('section', 'section.json', section, options),
    calibrate: (scene, options) => run('calibrate', 'scene.json', scene, options),
    check: (scene, options) => run('check', 'scene.json', scene, options),
    limit: (scene, options) => run('limit', 'scene.json', scene, options),
    simulate: (scene, options) => run('simulate', 'scene.json', scene, options),
  };
}
