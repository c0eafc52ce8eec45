/// What the browser keeps for the next visit. Browsers may forbid it; then nothing is kept.

export function stored(name: string): string | null {
  try {
    return localStorage.getItem(`kaustik.${name}`);
  } catch {
    return null;
  }
}

export function store(name: string, value: string): void {
  try {
    localStorage.setItem(`kaustik.${name}`, value);
  } catch {
    // Not kept.
  }
}

/// For this tab only.
export function storedHere(name: string): string | null {
  try {
    return sessionStorage.getItem(`kaustik.${name}`);
  } catch {
    return null;
  }
}

export function storeHere(name: string, value: string): void {
  try {
    sessionStorage.setItem(`kaustik.${name}`, value);
  } catch {
    // Not kept.
  }
}
