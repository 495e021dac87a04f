// The npm package in Node: the page's programs, and the command's numbers to the bit.
//
//   node node_test.mjs PACKAGE COMMAND SCENES PAGE
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {examples} from './examples.mjs';

const [pack, command, scenes, page] = process.argv.slice(2).map((path) => resolve(path));
const {default: ductile, DuctileError} = await import(pathToFileURL(join(pack, 'index.js')));
const {default: load} = await import(pathToFileURL(join(pack, 'world.js')));
const d = await ductile(), World = await load();
const folder = mkdtempSync(join(tmpdir(), 'ductile.'));

const native = (...words) => JSON.parse(execFileSync(command, [...words, '--json'], {encoding: 'utf8', maxBuffer: 1 << 30}));

/// A scene as an object, with the drawings that it names.
function scene(name) {
  const files = {};
  for (const drawing of readdirSync(scenes).filter((file) => file.endsWith('.svg')))
    files[drawing] = readFileSync(join(scenes, drawing), 'utf8');
  return {object: JSON.parse(readFileSync(join(scenes, name), 'utf8')), files};
}
const names = readdirSync(scenes).filter((name) => name.endsWith('.scene.json'));
assert.ok(names.length >= 15, `${names.length} scenes`);

/// The largest difference of two answers' numbers, in parts of the largest of its kind (by the key it stands under; N, Q
/// and M are of one, as the least of them are what others leave).
function difference(one, other) {
  const most = {}, apart = {};
  const walk = (a, b, key) => {
    assert.equal(typeof a, typeof b, key);
    if (typeof a === 'number') {
      most[key] = Math.max(most[key] ?? 0, Math.abs(a));
      apart[key] = Math.max(apart[key] ?? 0, Math.abs(a - b));
    } else if (a !== null && typeof a === 'object') {
      assert.deepEqual(Object.keys(a), Object.keys(b), key);
      for (const k of Object.keys(a)) walk(a[k], b[k], key === 'usage' || /^\d+$/.test(k) ? key : /^[NQM]$/.test(k) ? 'force' : k);
    } else {
      assert.equal(a, b, key);
    }
  };
  walk(one, other, '');
  return Math.max(0, ...Object.keys(apart).map((key) => apart[key] / Math.max(most[key], 1e-9)));  // where all are nothing
}

const tests = {
  'the page\'s programs print what it says': () => {
    mkdirSync(join(folder, 'node_modules'));
    symlinkSync(pack, join(folder, 'node_modules/ductile'));
    examples(page).forEach(({program, prints}, i) => {
      const file = join(folder, `${i}.mjs`);
      writeFileSync(file, program);
      const ran = spawnSync(process.execPath, [file], {encoding: 'utf8'});
      assert.equal(ran.stdout + ran.stderr, prints);
    });
  },

  // Sines and arc tangents are those of the C library.
  'sections are the command\'s within 1e-13': () => {
    const tube = {outer: [[0, 0], [0.2, 0], [0.2, 0.2], [0, 0.2]],
                  holes: [[[0.008, 0.008], [0.192, 0.008], [0.192, 0.192], [0.008, 0.192]]], material: 'S355'};
    const file = join(folder, 'tube.section.json');
    for (const regions of [[tube], [tube, {outer: tube.holes[0], material: 'concrete'}],
                           [{outer: [[0, 0], [0.3, 0.01], [0.29, 0.02], [0.013, 0.02], [0.01, 0.3], [0, 0.31]], material: 'S235'}]]) {
      writeFileSync(file, JSON.stringify({regions}));
      for (const angle of [90, 0, 30, -107.3])
        assert.ok(difference(native('section', file, '--angle', String(angle)), d.section({regions}, {angle})) < 1e-13);
    }
  },

  'every scene is calibrated to the bit': () => {
    for (const name of names) {
      const {object, files} = scene(name);
      assert.deepEqual(d.calibrate(object, {files}), native('calibrate', join(scenes, name)), name);
    }
  },

  // SPQR adds up in the order of the BLAS that it is linked with.
  'every scene is checked within 1e-9': () => {
    for (const name of names) {
      const {object, files} = scene(name);
      let theirs;
      try {
        theirs = native('check', join(scenes, name));
      } catch (error) {
        assert.throws(() => d.check(object, {files}), (own) => own.exit === error.status, name);
        continue;
      }
      const ours = d.check(object, {files});
      delete ours.first_to_yield, delete theirs.first_to_yield;  // any of those that yield at one load
      const apart = difference(theirs, ours);
      assert.ok(apart < 1e-9, `${name}: ${apart}`);
    }
  },

  'load factors of collapse are the command\'s within 1e-9': () => {
    let compared = 0;
    for (const name of names) {
      const {object, files} = scene(name);
      let theirs;
      try {
        theirs = native('limit', join(scenes, name)).load_factor;
      } catch (error) {
        assert.throws(() => d.limit(object, {files}), (own) => own.exit === error.status, name);
        continue;
      }
      const ours = d.limit(object, {files}).load_factor;
      if (theirs === null) { assert.equal(ours, null, name); continue; }
      assert.ok(Math.abs(ours - theirs) <= 1e-9 * theirs, `${name}: ${ours} ${theirs}`);
      ++compared;
    }
    assert.ok(compared >= 3, `${compared} load factors`);
  },

  'every scene runs 600 steps to the bit': () => {
    for (const name of names) {
      const {object, files} = scene(name);
      const {status, stdout} = spawnSync(command, ['simulate', join(scenes, name), '--time', '10', '--json'],
                                         {encoding: 'utf8', maxBuffer: 1 << 30});
      const theirs = JSON.parse(stdout);
      if (status !== 0) {  // a solve has missed its tolerance: the function says so, and a world goes on
        assert.equal(theirs.unsolved > 0, true, name);
        assert.throws(() => d.simulate(object, {files, time: 10}), (own) => own.exit === status, name);
        const world = new World(object);
        world.step(600);
        assert.deepEqual([...world.poses()], theirs.pieces.flatMap((p) => [...p.position, p.angle]), name);
        world.delete();
        continue;
      }
      const ours = d.simulate(object, {files, time: 10});
      delete ours.time_per_step_us, delete theirs.time_per_step_us;
      assert.deepEqual(ours, theirs, name);
    }
  },

  'a world runs as the command does': () => {
    for (const name of ['car_heavy.scene.json', 'cantilever.scene.json', 'CS1.scene.json']) {
      const world = new World(scene(name).object);
      world.step(300);
      const poses = native('simulate', join(scenes, name), '--time', '5').pieces.flatMap((p) => [...p.position, p.angle]);
      assert.deepEqual([...world.poses()], poses, name);
      world.delete();
    }
  },

  // Contacts with a structure are rows of its problem only where Box2D's memory is laid out as assumed, by the size of a
  // pointer too; where it is not, they push pieces as any body does, and no bit past the first touch is the command's.
  'a block and a disc on a bridge run as the command has them': () => {
    const bridge = {
      bodies: [
        {name: 'banks', type: 'static', outline: [[-2, -1], [12, -1], [12, -0.5], [10.5, -0.5], [10.5, 0], [10, 0], [10, -0.5], [0, -0.5], [0, 0], [-0.5, 0], [-0.5, -0.5], [-2, -0.5]]},
        {name: 'deck', outline: [[0, -0.3], [10, -0.3], [10, 0], [0, 0]], depth: 0.1, material: 'S235', split: {pieces: 10}},
        {name: 'block', outline: [[4, 0.5], [6, 0.5], [6, 1.5], [4, 1.5]], depth: 2, material: 'S235'}],
      joints: [{between: ['banks', 'deck']}]};
    const file = join(folder, 'bridge.json');
    writeFileSync(file, JSON.stringify(bridge));
    const world = new World(bridge);
    world.step(240);
    const after = native('simulate', file, '--time', '4');
    assert.deepEqual([...world.poses()], after.pieces.flatMap((p) => [...p.position, p.angle]));
    assert.ok(after.joints.some((joint) => joint.accumulated_rotation > 0));
    world.delete();
  },

  'definitions are the command\'s': () => {
    const name = 'car.scene.json', {object} = scene(name);
    for (const to of ['box2d', 'rube']) assert.deepEqual(d.calibrate(object, {to}), native('calibrate', join(scenes, name), '--to', to));
    writeFileSync(join(folder, 'scene.json'), JSON.stringify(object));
    assert.equal(d.calibrate(object, {to: 'cpp'}), execFileSync(command, ['calibrate', 'scene.json', '--to', 'cpp'], {cwd: folder, encoding: 'utf8'}));
  },

  'what is wrong throws with the command\'s lines': () => {
    const wrong = {bodies: [{name: 'a', outline: [[0, 0], [1, 1], [1, 0], [0, 1]], material: 'S235', depth: 0}]};
    const file = join(folder, 'scene.json');
    writeFileSync(file, JSON.stringify(wrong));
    const said = spawnSync(command, ['check', 'scene.json'], {cwd: folder, encoding: 'utf8'});
    assert.throws(() => d.check(wrong), (error) => error instanceof DuctileError && error.exit === said.status &&
        error.message + '\n' === said.stderr);
    assert.throws(() => new World(wrong), (error) => error.message + '\n' === said.stderr);
    assert.throws(() => d.simulate(wrong, {time: -1}), /command line/);
    assert.throws(() => d.simulate(wrong, {tiem: 1}), /command line/);
    assert.throws(() => d.calibrate(wrong, {out: 'x'}), TypeError);
    assert.throws(() => d.calibrate('{', {}), DuctileError);
  },

  'what is wrong with a body, a force or a count throws and leaves the world as it is': () => {
    const {object, files} = scene('cantilever.scene.json'), world = new World(object, {files}), poses = world.poses();
    const square = [[0, 0], [1, 0], [1, 1], [0, 1]];
    for (const def of [{}, {radius: -1}, {radius: NaN}, {radius: 1, polygon: square}, {polygon: square.slice(0, 2)}, {polygon: [[0, 0], [1, 0], [2, 0]]},
                       {polygon: [[0, 0], [2, 0], [0.1, 0.1], [0, 2]]}, {polygon: [[0, 0], [1e-3, 0], [0, 1e-3]]},
                       {polygon: Array.from({length: 9}, (_, i) => [Math.cos(i * 0.69), Math.sin(i * 0.69)])}, {polygon: [[0, 0], [1, 0], [0]]},
                       {radius: 1, at: [0, Infinity]}, {radius: 1, at: [0]}, {radius: 1, density: -1}, {radius: 1, mass: 3}])
      assert.throws(() => world.add(def), /a body/, JSON.stringify(def));
    for (const index of [0, -1, 1.5, 'x']) assert.throws(() => world.remove(index), RangeError);
    const index = world.add({polygon: square, at: [50, 50]});
    world.remove(index);
    assert.throws(() => world.remove(index), RangeError);
    assert.ok([...world.addedPoses()].every(Number.isNaN));
    for (const count of [-1, 0.5, NaN, '2']) assert.throws(() => world.step(count), RangeError);
    assert.throws(() => world.applyForce('nobody', [1, 0]), RangeError);
    assert.throws(() => world.applyForce(0, [NaN, 0]), TypeError);
    assert.throws(() => new World(object, {solver: 'quick'}), /solver/);
    assert.throws(() => new World(object, {dt: 0}), RangeError);
    assert.throws(() => new World(object, {files: {'a/b': ''}}), TypeError);
    assert.deepEqual(world.poses(), poses);
    world.delete();
  },

  'a thousand calls and a hundred worlds need no more memory than ten': () => {
    const {object} = scene('cantilever.scene.json');
    const many = (count) => {
      for (let i = 0; i < count; ++i) d.section({regions: [{outer: [[0, 0], [1, 0], [0, 1]], material: 'oak'}]});
      for (let i = 0; i < count / 10; ++i) new World(object).delete();
      return process.memoryUsage().arrayBuffers + process.memoryUsage().external;
    };
    const few = many(10);
    assert.ok(many(1000) < few + (16 << 20));
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  const start = performance.now();
  try {
    test();
    console.log(`ok      ${name} (${Math.round(performance.now() - start)} ms)`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}\n${error.stack.slice(0, 3000)}`);
  }
}
rmSync(folder, {recursive: true});
process.exitCode = failed ? 1 : 0;
