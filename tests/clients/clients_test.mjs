// What ductile exports, in engines that are not our build: stock definitions hold and give way as the capacities say.
//
//   node clients_test.mjs COMMAND SCENES     exit 77: the packages of package.json are not here
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';

if (!existsSync(new URL('node_modules/box2d-wasm', import.meta.url))) {
  console.log('SKIPPED: the packages of tests/clients/package.json are not installed');
  process.exit(77);
}

// A bar of S355, L × h × b, that sticks out of a wall: its section's plastic moment and bending stiffness, what its
// weight does at the root, and where it comes to rest as a rigid-plastic bar: its fall m g L/2 sin θ is M_p θ.
const L = 4, h = 0.5, b = 0.2, mass = 7850 * L * h * b;
const plasticMoment = b * h * h / 4 * 355e6, stiffness = 210e9 * b * h ** 3 / 12 / (L / 2);
const gravityFor = (share) => [0, -share * plasticMoment / (mass * L / 2)];
function rest(share) {
  let low = 0.01, high = 3;
  while (high - low > 1e-9) {
    const middle = (low + high) / 2;
    if (share * Math.sin(middle) > middle) low = middle; else high = middle;
  }
  return low;
}

const scene = {
  bodies: [{name: 'wall', type: 'static', outline: [[-1, -1], [0, -1], [0, 1], [-1, 1]]},
           {name: 'bar', outline: [[0, 0], [L, 0], [L, h], [0, h]], material: 'S355', depth: b}],
  joints: [{between: ['wall', 'bar']}]};

const command = process.argv[2], scenes = resolve(process.argv[3]), folder = mkdtempSync(join(tmpdir(), 'ductile.'));
function run(...arguments_) {
  return JSON.parse(execFileSync(command, arguments_, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore']}));
}
function exported(scene, to, ...options) {
  const file = join(folder, 'scene.json');
  writeFileSync(file, JSON.stringify(scene));
  return run('calibrate', file, '--to', to, ...options);
}

/// How far `bar` has turned down after 5 s and after 10 s under that share of its plastic moment.
function turned(world, share) {
  world.gravity(gravityFor(share));
  return [0, 1].map(() => {
    for (let i = 0; i < 300; ++i) world.step();
    return -world.angle('bar');
  });
}

// --- what each engine loads: `yields` is the scene with hinges that give way, `holds` the one that does not ---

const box2d = async (module) => {
  const {load} = await import(module);
  return {yields: (scene) => load(exported(scene, 'box2d'), (joint) => joint.yields ?? joint.holds),
          holds: (scene) => load(exported(scene, 'box2d'), (joint) => joint.holds)};
};
const rube = async (module) => {
  const {load} = await import(module);
  return {yields: (scene) => load(exported(scene, 'rube')),
          holds: (scene) => load(exported(scene, 'rube', '--as', 'weld'))};
};
const engines = {
  'Box2D 2.4.1, --to box2d': await box2d('./box2d_2.mjs'),
  'Box2D 3, --to box2d': await box2d('./box2d_3.mjs'),
  '@box2d/core, --to box2d': await box2d('./box2d_core.mjs'),
  'phaser-box2d, --to box2d': await box2d('./phaser_box2d.mjs'),
  'planck.js, --to rube': await rube('./rube_planck.mjs'),
};

const tests = {};
for (const [name, {yields, holds}] of Object.entries(engines)) {
  tests[`${name}: bodies weigh what the outline says`] = () => {
    const world = holds(scene);
    assert.ok(Math.abs(world.mass('bar') / mass - 1) < 1e-6);
    assert.deepEqual(world.position('bar'), [L / 2, h / 2]);
  };
  // Gravity comes at once: before the motor holds, its first step lets the bar turn by a hundredth.
  tests[`${name}: the hinge holds at 0.9 of the plastic moment`] = () => {
    const [early, late] = turned(yields(scene), 0.9);
    assert.ok(early < 0.015, `${early}`);
    assert.ok(Math.abs(late - early) < 1e-4, `${early} ${late}`);
  };
  tests[`${name}: the hinge gives way at 1.1, and rests where its plastic work is its fall`] = () => {
    const [early, late] = turned(yields(scene), 1.1);
    assert.ok(Math.abs(late / rest(1.1) - 1) < 0.02, `${late} ${rest(1.1)}`);
    assert.ok(Math.abs(late - early) < 1e-4, `${early} ${late}`);
  };
  tests[`${name}: the weld never gives way, and bends by M/k`] = () => {
    for (const share of [0.9, 1.1, 5]) {
      const [, late] = turned(holds(scene), share);
      const moment = share * plasticMoment * Math.cos(late);
      assert.ok(Math.abs(late / (moment / stiffness) - 1) < 1e-3, `${late} ${moment / stiffness}`);
    }
  };
  tests[`${name}: pins turn and a roller rolls`] = () => {
    const bridge = {
      bodies: [{name: 'bar', outline: [[0, 0], [L, 0], [L, h], [0, h]], material: 'S355', depth: b}],
      supports: [{body: 'bar', at: [0, h / 2], fix: ['x', 'y']}, {body: 'bar', at: [L, h / 2], fix: ['y']}]};
    const world = yields(bridge);
    for (let i = 0; i < 300; ++i) world.step();
    const [x, y] = world.position('bar');
    assert.ok(Math.hypot(x - L / 2, y - h / 2) < 0.01, `${x} ${y}`);
    const pendulum = yields({...bridge, supports: [bridge.supports[0]]});
    let lowest = 0;
    for (let i = 0; i < 120; ++i) {
      pendulum.step();
      lowest = Math.min(lowest, pendulum.position('bar')[1]);
    }
    assert.ok(lowest < h / 2 - 0.95 * L / 2, `${lowest}`);
  };
}

// Ten seconds of scenes of ours in welds that never give way: bodies are where stock Box2D 2.4.1 has them, within a
// twentieth of the scene's size. (Long chains of stock welds fold, in each engine another way.)
for (const name of ['B1-1', 'B1-2', 'B2-1', 'B3-2', 'B4-1', 'CS1', 'collapse']) {
  const scene = join(scenes, `${name}.scene.json`);
  let expected;
  for (const [engine, {holds}] of Object.entries(engines)) {
    tests[`${engine}: ${name} plays 600 frames as in stock Box2D 2.4.1`] = () => {
      const plan = JSON.parse(readFileSync(scene));
      delete plan.loads;  // which are no definitions of an engine
      delete plan.gravity_ramp;
      for (const body of plan.bodies)
        if (typeof body.outline === 'string') body.outline = join(scenes, body.outline);
      const world = holds(plan);
      expected ??= run('simulate', join(folder, 'scene.json'), '--solver', 'stock', '--time', '10', '--json').pieces;
      for (let i = 0; i < 600; ++i) world.step();
      const at = expected.map(({position}) => position);
      const size = Math.hypot(...[0, 1].map((k) => Math.max(...at.map((p) => p[k])) - Math.min(...at.map((p) => p[k]))));
      for (const {name, position} of expected) {
        const [x, y] = world.position(name);
        const away = Math.hypot(x - position[0], y - position[1]);
        assert.ok(away < size / 20, `${name} is ${away} m away, in a scene of ${size} m`);
      }
    };
  }
}

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    test();
    console.log(`ok      ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
rmSync(folder, {recursive: true});
process.exit(failed ? 1 : 0);  // Box2D 3 would keep its threads waiting
