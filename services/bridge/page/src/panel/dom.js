/** An element with its class, text and children. Text from the network is only ever set as text. */
export function element(tag, className = '', ...children) {
  const node = document.createElement(tag);
  if (className) node.className = className;
  node.append(...children.filter((child) => child !== null && child !== ''));
  return node;
}

export const find = (id) => document.getElementById(id);
