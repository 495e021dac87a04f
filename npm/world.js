// A Box2D world with a structure in it, for games. No part of this door is under the GPL.
import factory from './world_core.js';
import {instantiate} from './instantiate.js';

const body = {at: [0, 0], angle: 0, velocity: [0, 0], bullet: false, density: 1000, friction: 0.5, restitution: 0,
              radius: 0, polygon: []};

const numbers = (list) => list.flat().every(Number.isFinite);

/** A body's definition with what it leaves out; what Box2D would assert is an error here. */
function whole(def) {
  for (const name of Object.keys(def)) if (!(name in body)) throw new TypeError(`a body has no '${name}'`);
  const all = {...body, ...def}, {at, velocity, polygon, radius, angle, density, friction, restitution} = all;
  if (!numbers([at, velocity, polygon, [radius, angle, density, friction, restitution]].flat()) || at.length !== 2 || velocity.length !== 2)
    throw new TypeError('a body is of finite numbers, with at and velocity as [x, y]');
  if (radius < 0 || density < 0 || friction < 0 || restitution < 0) throw new RangeError('a body has no number below 0');
  if (radius > 0 ? polygon.length > 0 : !isConvex(polygon))
    throw new RangeError('a body is a disc with a radius, or a convex polygon of 3 to 8 corners in their order, 1 cm apart or more');
  return all;
}

function isConvex(polygon) {
  if (polygon.length < 3 || polygon.length > 8 || polygon.some((corner) => corner.length !== 2)) return false;
  const next = (i, by) => polygon[(i + by) % polygon.length];
  const sides = polygon.map(([x, y], i) => [next(i, 1)[0] - x, next(i, 1)[1] - y]);
  const turns = sides.map(([x, y], i) => {
    const [u, v] = sides[(i + 1) % sides.length];
    return (x * v - y * u) / (Math.hypot(x, y) * Math.hypot(u, v));
  });
  return sides.every(([x, y]) => Math.hypot(x, y) >= 0.01) && (turns.every((turn) => turn > 0.001) || turns.every((turn) => turn < -0.001));
}

/** Loads the module; the class that it gives makes worlds. */
export default async function load() {
  const core = await instantiate(factory, 'world_core.wasm');

  return class World {
    #own;
    #there = [];  // indices of the bodies added and not removed
    constructor(scene, {solver = 'direct', dt = 1 / 60, files = {}} = {}) {
      if (!(dt > 0 && dt < Infinity)) throw new RangeError(`dt is ${dt}; let it be a time in s, above 0`);
      const names = Object.keys(files);
      if (names.some((name) => name.includes('/'))) throw new TypeError('files are named without a folder');
      try {
        for (const name of names) core.FS.writeFile(name, files[name]);
        this.#own = new core.GameWorld(typeof scene === 'string' ? scene : JSON.stringify(scene), solver, dt);
      } finally {
        for (const name of names) if (core.FS.analyzePath(name).exists) core.FS.unlink(name);
      }
      const {pieces, joints} = this.#own.plan();
      this.pieces = pieces;
      this.joints = joints;
    }
    get time() { return this.#own.time(); }
    step(count = 1) {
      if (!Number.isInteger(count) || count < 0) throw new RangeError(`count is ${count}; let it be a number of steps`);
      this.#own.step(count);
    }
    poses() { return Float64Array.from(this.#own.poses()); }
    readings() {
      const numbers = Float64Array.from(this.#own.joints());
      return this.joints.map(({name}, i) => {
        const [N, Q, M, usage, rotation, capacityUsed, broken] = numbers.subarray(7 * i, 7 * i + 7);
        return {name, N, Q, M, usage: Number.isNaN(usage) ? null : usage, rotation, capacityUsed, broken: broken === 1};
      });
    }
    events() { return this.#own.events().map((event) => ({...event, joint: this.joints[event.joint].name})); }
    applyForce(piece, force, at) { this.#act('push', piece, force, at); }
    applyImpulse(piece, impulse, at) { this.#act('impulse', piece, impulse, at); }
    add(def) {
      this.#there.push(this.#own.add(whole(def)));
      return this.#there.at(-1);
    }
    remove(index) {
      if (!this.#there.includes(index)) throw new RangeError(`there is no added body ${index}`);
      this.#own.remove(index);
      this.#there.splice(this.#there.indexOf(index), 1);
    }
    addedPoses() { return Float64Array.from(this.#own.addedPoses()); }
    delete() { this.#own.delete(); }

    #act(how, piece, [x, y], at) {
      const index = typeof piece === 'number' ? piece : this.pieces.findIndex(({name}) => name === piece);
      if (!this.pieces[index]) throw new RangeError(`there is no piece '${piece}'`);
      const [px, py] = at ?? this.poses().subarray(3 * index, 3 * index + 2);
      if (!numbers([x, y, px, py])) throw new TypeError('a force, an impulse and a point are finite numbers');
      this.#own[how](index, x, y, px, py);
    }
  };
}
