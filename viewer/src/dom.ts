// Elements in a line.

type Child = Node | string;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** `on...` are listeners, booleans are there or not, `text` is what it says. */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const own = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") own.addEventListener(name.slice(2), value);
    else if (name === "text") own.textContent = String(value);
    else if (typeof value === "boolean") own.toggleAttribute(name, value);
    else own.setAttribute(name, String(value));
  }
  own.append(...children);
  return own;
}

export function download(name: string, content: Blob): void {
  const link = make("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
