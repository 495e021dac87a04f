/** x and y: m, or N, or N s; y is up. */
export type Vector = readonly [number, number];

export interface Piece {
  readonly name: string;
  /** Name of the scene's body that it is cut from. */
  readonly body: string;
  /** kg; 0 where it stands still. */
  readonly mass: number;
  /** m about the centre of mass, as the scene places it; empty for a disc. */
  readonly outline: readonly Vector[];
  /** m: radius of a disc, else 0. */
  readonly circle: number;
}

export interface Joint {
  readonly name: string;
  /** Indices of its pieces; -1: the ground. */
  readonly a: number;
  readonly b: number;
  /** Capacities in tension, shear and bending: N, N, N m. Infinity: unlimited. */
  readonly N: number;
  readonly Q: number;
  readonly M: number;
}

export interface Reading {
  readonly name: string;
  /** Of the last step: N positive in tension, N, N m. 0 once broken. */
  readonly N: number;
  readonly Q: number;
  readonly M: number;
  /** The largest |value| / capacity; null where all are unlimited. */
  readonly usage: number | null;
  /** rad: accumulated plastic rotation. */
  readonly rotation: number;
  /** It breaks at 1. */
  readonly capacityUsed: number;
  readonly broken: boolean;
}

export interface JointEvent {
  readonly time: number;
  readonly joint: string;
  readonly kind: 'yields' | 'breaks';
  readonly mode: 'tension' | 'compression' | 'shear' | 'rotation';
  /** N or N m. */
  readonly force: number;
  /** J that the joint has dissipated so far. */
  readonly energy: number;
}

/** A body of the game's own: a disc where `radius` is given, else a convex polygon of 3 to 8 corners about `at`, in
 * their order (either way round) and 1 cm apart or more. Throws a TypeError or RangeError for anything else. */
export interface BodyDef {
  radius?: number;
  polygon?: readonly Vector[];
  at?: Vector;
  /** rad */
  angle?: number;
  /** m/s */
  velocity?: Vector;
  /** kg/m², 1000 unless given; with a thickness in m, a material's density times that. */
  density?: number;
  friction?: number;
  restitution?: number;
  /** Continuous collision for what is small and fast. */
  bullet?: boolean;
}

export interface Options {
  /** All joints together; the paper's own scheme; Box2D's welds, which never yield. */
  solver?: 'direct' | 'iterative' | 'stock';
  /** s: the step, 1/60 unless given. */
  dt?: number;
  /** Drawings that the scene names, by their names. */
  files?: Record<string, string>;
}

export declare class World {
  /** Of a scene file's object (or text). Throws an Error with the lines that the command would print. */
  constructor(scene: object | string, options?: Options);
  readonly pieces: readonly Piece[];
  readonly joints: readonly Joint[];
  /** s */
  readonly time: number;
  /** Steps: loads, b2World::Step with 8 and 3 iterations, then breaks and events. */
  step(count?: number): void;
  /** x, y, angle of piece after piece: m of its centre of mass, rad since the start. */
  poses(): Float64Array;
  readings(): Reading[];
  /** Yields and breaks since the last call. */
  events(): JointEvent[];
  /** N in the next step, at a point of the world or the centre of mass; the piece by name or index. */
  applyForce(piece: string | number, force: Vector, at?: Vector): void;
  /** N s, at once. */
  applyImpulse(piece: string | number, impulse: Vector, at?: Vector): void;
  /** Adds a body of the game's own; the index by which it is known. */
  add(def: BodyDef): number;
  remove(index: number): void;
  /** x, y, angle of what was added, in its order; NaN where it is removed. */
  addedPoses(): Float64Array;
  /** Frees the world's memory, which no garbage collector sees. */
  delete(): void;
}

/** Loads the module, once per page. */
export default function load(): Promise<typeof World>;
