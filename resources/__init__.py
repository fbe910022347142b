"""The data that Busk ships: sample bodies, templates, fonts, icons, words. No code."""
