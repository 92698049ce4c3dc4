// Exact numbers: doubles as rational numbers of integers of any size.
//
// A rational is { n, d }, d > 0, not reduced. Functions round only if their comment says so.

const view = new DataView(new ArrayBuffer(8));

/// The bits of a double, and the double of some bits.
function bitsOf(x) {
  view.setFloat64(0, x);
  return view.getBigUint64(0);
}
function doubleOf(bits) {
  view.setBigUint64(0, bits);
  return view.getFloat64(0);
}

export const bitLength = (n) => (n < 0n ? -n : n).toString(16).length * 4;
export const absolute = (n) => (n < 0n ? -n : n);

/// A finite double as m 2^e, m odd or 0.
export function dyadic(x) {
  const bits = bitsOf(x);
  const exponent = Number((bits >> 52n) & 0x7ffn);
  let m = bits & ((1n << 52n) - 1n);
  if (exponent !== 0) m |= 1n << 52n;
  if (m === 0n) return { m: 0n, e: 0 };
  let e = Math.max(exponent, 1) - 1075;
  while ((m & 1n) === 0n) {
    m >>= 1n;
    e += 1;
  }
  return { m: bits >> 63n ? -m : m, e };
}

export function rational(x) {
  const { m, e } = dyadic(x);
  return e < 0 ? { n: m, d: 1n << BigInt(-e) } : { n: m << BigInt(e), d: 1n };
}

export const add = (a, b) => ({ n: a.n * b.d + b.n * a.d, d: a.d * b.d });
export const subtract = (a, b) => ({ n: a.n * b.d - b.n * a.d, d: a.d * b.d });
export const multiply = (a, b) => ({ n: a.n * b.n, d: a.d * b.d });
export function divide(a, b) {
  return b.n < 0n ? { n: -a.n * b.d, d: -a.d * b.n } : { n: a.n * b.d, d: a.d * b.n };
}
export function compare(a, b) {
  const difference = a.n * b.d - b.n * a.d;
  return difference < 0n ? -1 : difference > 0n ? 1 : 0;
}
export const zero = { n: 0n, d: 1n };
export const one = { n: 1n, d: 1n };

function greatestDivisor(a, b) {
  while (b !== 0n) [a, b] = [b, a % b];
  return a;
}
export function reduced({ n, d }) {
  const divisor = greatestDivisor(absolute(n), d);
  return { n: n / divisor, d: d / divisor };
}

/// floor(n 2^shift / d), for d > 0 and n ≥ 0.
const shiftedQuotient = (n, d, shift) => (shift >= 0 ? (n << BigInt(shift)) / d : n / (d << BigInt(-shift)));

/// x 2^e, where e may be beyond the exponents of doubles.
function scaled(x, e) {
  while (e < -1000) {
    x *= 2 ** -1000;
    e += 1000;
  }
  while (e > 1000) {
    x *= 2 ** 1000;
    e -= 1000;
  }
  return x * 2 ** e;
}

/// The double nearest to a rational, ties to even; infinite beyond the range.
export function nearest({ n, d }) {
  if (n === 0n) return 0;
  const sign = n < 0n ? -1 : 1;
  const size = absolute(n);
  const exact = (shift) => {
    const quotient = shiftedQuotient(size, d, shift);
    const rest = shift >= 0 ? (size << BigInt(shift)) - quotient * d : size - quotient * (d << BigInt(-shift));
    return { quotient, isExact: rest === 0n };
  };
  const shift = 72 - (bitLength(size) - bitLength(d));
  const { quotient, isExact } = exact(shift);
  const rough = scaled(Number(quotient), -shift);
  if (rough >= 2 ** -1020) {
    // An odd last bit represents the truncated part: far below the last bit of a double.
    return sign * scaled(Number(isExact ? quotient : quotient | 1n), -shift);
  }
  // Near the subnormal numbers: the multiple of 2^-1074, whose factor is its bits.
  const half = exact(1075);
  let bits = half.quotient >> 1n;
  const isOver = (half.quotient & 1n) === 1n && (!half.isExact || (bits & 1n) === 1n);
  if (isOver) bits += 1n;
  return sign * doubleOf(bits);
}

/// log2 of a positive rational, as a double.
export function log2({ n, d }) {
  const size = (x) => {
    const shift = Math.max(bitLength(x) - 64, 0);
    return Math.log2(Number(x >> BigInt(shift))) + shift;
  };
  return size(n) - size(d);
}

/// The square root of a rational, to some 60 bits.
export function squareRoot({ n, d }) {
  if (n === 0n) return zero;
  const half = Math.floor((130 - (bitLength(n) - bitLength(d))) / 2);
  const square = shiftedQuotient(n, d, 2 * half);
  let root = BigInt(Math.floor(Math.sqrt(Number(square))));
  for (let i = 0; i < 3; ++i) root = (root + square / root) >> 1n;
  return half >= 0 ? { n: root, d: 1n << BigInt(half) } : { n: root << BigInt(-half), d: 1n };
}

// ---- Texts --------------------------------------------------------------------------------------

/// A double in the form of C's %a: "0x1.8p-3".
export function hexadecimalText(x) {
  const bits = bitsOf(x);
  const sign = bits >> 63n ? "-" : "";
  const exponent = Number((bits >> 52n) & 0x7ffn);
  const fraction = (bits & ((1n << 52n) - 1n)).toString(16).padStart(13, "0").replace(/0+$/, "");
  if (exponent === 0 && fraction === "") return `${sign}0x0p+0`;
  const power = Math.max(exponent, 1) - 1023;
  return `${sign}0x${exponent === 0 ? 0 : 1}${fraction && `.${fraction}`}p${power < 0 ? "" : "+"}${power}`;
}

export function rationalText(value) {
  const { n, d } = reduced(value);
  return d === 1n ? String(n) : `${n}/${d}`;
}

/// A rational to some digits, of any size.
export function shortText(value, digits = 6) {
  if (value.n === 0n) return "0";
  const near = nearest(value);
  if (Math.abs(near) > 1e-300 && Math.abs(near) < 1e300) return doubleText(Number(near.toPrecision(digits)));
  const size = absolute(value.n);
  const power = Math.floor((bitLength(size) - bitLength(value.d)) * Math.log10(2));
  const ten = 10n ** BigInt(Math.abs(power));
  const front = nearest(power < 0 ? { n: size * ten, d: value.d } : { n: size, d: value.d * ten });
  const [mantissa, rest] = front.toExponential(digits - 1).split("e");
  return `${value.n < 0n ? "-" : ""}${Number(mantissa)}e${Number(rest) + power}`;
}

/// A double with the fewest digits that distinguish it from its neighbours; small and large ones
/// with a power of ten.
export function doubleText(x) {
  const size = Math.abs(x);
  return size === 0 || (size >= 1e-3 && size < 1e15) ? String(x) : x.toExponential().replace("e+", "e");
}

/// The rational of a text: "1/3", "-0x1.8p-3", "2.5e-4"; null if it is none.
export function parseRational(text) {
  const word = text.trim();
  const slash = word.indexOf("/");
  if (slash >= 0) {
    const [top, bottom] = [parseRational(word.slice(0, slash)), parseRational(word.slice(slash + 1))];
    return top === null || bottom === null || bottom.n === 0n ? null : divide(top, bottom);
  }
  // One way only to match a run of digits: the time is linear in a text that is no number, too.
  const hexadecimal = /^([-+]?)0x([0-9a-f]*)(?:\.([0-9a-f]*))?(?:p([-+]?\d{1,5}))?$/i.exec(word);
  const decimal = /^([-+]?)(\d*)(?:\.(\d*))?(?:e([-+]?\d{1,5}))?$/i.exec(word);
  const match = hexadecimal || decimal;
  const fraction = (match && match[3]) || "";
  if (match === null || match[2] + fraction === "") return null;
  const base = hexadecimal ? 16n : 10n;
  const digits = BigInt((hexadecimal ? "0x" : "") + match[2] + fraction);
  const power = hexadecimal ? 2n : 10n;
  const exponent = BigInt(match[4] || 0);
  const down = base ** BigInt(fraction.length) * (exponent < 0n ? power ** -exponent : 1n);
  const value = { n: digits * (exponent > 0n ? power ** exponent : 1n), d: down };
  return match[1] === "-" ? { n: -value.n, d: value.d } : value;
}

/// The double nearest to the number of a text; NaN if it is not a finite number. −0 keeps its sign.
export function parseDouble(text) {
  const value = parseRational(text);
  if (value === null) return NaN;
  const near = nearest(value);
  if (near === 0 && text.trim().startsWith("-")) return -0;
  return Number.isFinite(near) ? near : NaN;
}
