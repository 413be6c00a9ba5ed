// Makes elements. Texts become text nodes, so that nothing from a file is ever read as HTML.

type Child = Node | string | null | undefined;

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  for (const child of children) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}

/** The element of index.html with this id. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`index.html has no element ${id}`);
  return found as T;
}

/** A button that looks like text and does something. */
export function linkButton(text: string, action: () => void, ...more: Child[]): HTMLButtonElement {
  const button = el('button', { type: 'button', class: 'link' }, text, ...more);
  button.addEventListener('click', action);
  return button;
}

export function swatch(rgb: readonly number[]): HTMLElement {
  const box = el('span', { class: 'swatch', 'aria-hidden': 'true' });
  box.style.backgroundColor = `rgb(${rgb.map((v) => Math.round(v)).join(' ')})`;
  return box;
}
