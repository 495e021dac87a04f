/** What the command refuses (exit 2) or fails at (exit 1): its lines, `file:place: what is wrong; what would be right`. */
export declare class DuctileError extends Error {
  readonly lines: string[];
  readonly exit: 1 | 2;
}

/** An option of the command line is a property: --velocity-iterations 8 is velocityIterations: 8. */
export interface CommonOptions {
  /** Files that the scene names, such as drawings, by their names. */
  files?: Record<string, string>;
}
export interface SectionOptions extends CommonOptions {
  /** Bending direction, degrees from the x axis; 90 unless given. */
  angle?: number;
}
export interface CalibrateOptions extends CommonOptions {
  /** Definitions instead: json, box2d and rube are objects, cpp is text. */
  to?: 'json' | 'box2d' | 'cpp' | 'rube';
  /** Relative displacement error that bodies with `"split": "auto"` may have. */
  targetError?: number;
  leaveOut?: number;
  impact?: number;
  time?: number;
}
export interface SimulateOptions extends CommonOptions {
  /** s */
  time: number;
  /** s; 1/60 unless given. */
  dt?: number;
  solver?: 'direct' | 'iterative' | 'stock';
  velocityIterations?: number;
  positionIterations?: number;
}
export interface LimitOptions extends CommonOptions {
  fixedGravity?: boolean;
}

/** One number per row of a joint; null: unlimited. */
export interface Rows {
  N: number | null;
  Q: number | null;
  M: number | null;
}
export interface SectionResult {
  area: number;
  centroid: [number, number];
  N: number;
  Nc: number;
  Q: number;
  M: number;
  M_reverse: number;
  pna: number;
  EA: number | null;
  EI: number | null;
  elastic_centroid: [number, number];
  I: number | null;
  W_elastic: number | null;
  W_plastic: number | null;
  shape_factor: number | null;
  yield_moment: number | null;
  interaction: { N: number; M: number }[];
  [more: string]: unknown;
}
export interface CalibrateResult {
  bodies: {
    name: string;
    type: string;
    pieces: { name: string; mass: number; inertia: number; center: [number, number]; vertices: [number, number][] }[];
  }[];
  joints: {
    name: string;
    between: [string, string];
    anchor: [number, number];
    axis: [number, number];
    N: number | null;
    Nc: number | null;
    Q: number | null;
    M: number | null;
    M_reverse: number | null;
    stiffness: Rows;
    max_rotation: number | null;
    max_elongation: number | null;
    max_compression: number | null;
    max_slip: number | null;
    governed_by: Record<string, string>;
  }[];
  left_out: { what: string; error: number; time_saved: number }[];
  [more: string]: unknown;
}
export interface CheckResult {
  joints: { name: string; N: number; Q: number; M: number; usage: Rows; yields_at: number | null }[];
  reserve: number | null;
  first_to_yield: string[];
  [more: string]: unknown;
}
export interface LimitResult {
  load_factor: number | null;
  hinges: string[];
  [more: string]: unknown;
}
export interface SimulateResult {
  /** µs: the median of b2World::Step. */
  time_per_step_us: number | null;
  joints: {
    name: string;
    N: number;
    Q: number;
    M: number;
    usage: Rows;
    plastic_rotation: number;
    accumulated_rotation: number;
    plastic_axial: number;
    plastic_shear: number;
    capacity_used: number;
    broken: boolean;
    broken_at: number | null;
    dissipated: number;
  }[];
  pieces: { name: string; position: [number, number]; angle: number; velocity: [number, number]; angular_velocity: number }[];
  energy: Record<string, number | null>;
  [more: string]: unknown;
}

/** Each takes the object (or text) of a section or scene file, and returns what the command prints with --json. */
export interface Ductile {
  section(section: object | string, options?: SectionOptions): SectionResult;
  calibrate(scene: object | string, options: CalibrateOptions & { to: 'cpp' }): string;
  calibrate(scene: object | string, options: CalibrateOptions & { to: 'box2d' | 'rube' }): Record<string, unknown>;
  calibrate(scene: object | string, options?: CalibrateOptions): CalibrateResult;
  check(scene: object | string, options?: CommonOptions): CheckResult;
  limit(scene: object | string, options?: LimitOptions): LimitResult;
  simulate(scene: object | string, options: SimulateOptions): SimulateResult;
}

/** Loads the program. */
export default function ductile(): Promise<Ductile>;
