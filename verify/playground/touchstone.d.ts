/**
 * Exact continuous collision detection in WebAssembly: the oracle, the certified solver and the checker of certificates. All
 * answers are exact, and the same as those of the library in C++. One thread: call it from a worker where it must not block.
 */

export interface Query {
  /** A vertex and a face (v, f0, f1, f2), or two edges (ea0, ea1, eb0, eb1). */
  kind: "vertex_face" | "edge_edge";
  /** 24 numbers: x, y, z of the four points at t = 0, then at t = 1; flat, or of shape (8, 3). They move on straight lines. */
  coordinates: ArrayLike<number> | ArrayLike<ArrayLike<number>>;
  /** The distance at which primitives are in contact, not negative; by default 0. */
  separation?: number;
  /** How it is measured; by default l2. */
  norm?: "l2" | "linf";
}

/** An exact number: between two doubles that are next to each other, or equal to both; and as "P/Q", where it is rational. */
export interface Exact {
  lower: number;
  upper: number;
  exact: string | null;
}

export interface Decision {
  collides: boolean;
  /** The time of impact, and the polynomial that has it as its only root between lower and upper. */
  toi: (Exact & { polynomial: string }) | null;
  /** The place of the contact; null without a collision or with a separation. */
  u: Exact | null;
  v: Exact | null;
  /** For `check` and touchstone-check; null for numbers beyond the limits of the format. */
  certificate: string | null;
}

export interface Answer {
  /** Always right; error if a coordinate is not finite. */
  verdict: "yes" | "no" | "error";
  /** The time of impact is above toi_lower (or both are 0), and at most toi_upper; null without a collision. */
  toi_lower: number | null;
  toi_upper: number | null;
  /** The place, approximately. */
  u: number | null;
  v: number | null;
}

export interface Touchstone {
  /** The oracle. @throws Error if a number is not finite. */
  decide(query: Query): Decision;
  /** The certified solver: the same verdicts, faster. */
  solve(query: Query): Answer;
  /** Checks a certificate of one query. @throws Error if the text is no certificate. */
  check(certificate: string): { claim: string; accepted: boolean; reason: string };
}

/** Starts the module. @throws Error if this machine's arithmetic is not that of IEEE 754. */
export function open(): Promise<Touchstone>;

declare global {
  /** The same, in a page with <script src="touchstone.js">. */
  function openTouchstone(): Promise<Touchstone>;
}
